"""Words of answers and reports: numbers as people write them, lists, sentences."""

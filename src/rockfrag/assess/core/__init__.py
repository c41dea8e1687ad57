"""From outcomes to one probability: draws, fractions, parts of sources, decisions; functions on arrays."""

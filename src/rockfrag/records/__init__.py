"""Strong-motion records: one module per file format, catalogues and where records come from."""

"""What a study costs against its size."""

# The report: printed tables beside computed ones, figures, and the page that tells the findings.

"""Study files, the pipeline, reports, checks and the command line."""

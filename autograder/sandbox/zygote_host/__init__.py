"""The process that programs are forked from; run as a script, so that none of the grader's modules is in it."""

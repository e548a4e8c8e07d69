"""The checks of 08_capstone."""

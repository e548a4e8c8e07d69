"""The checks of NEW_CHAPTER."""

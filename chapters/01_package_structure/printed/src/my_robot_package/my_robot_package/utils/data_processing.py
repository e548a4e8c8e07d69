"""Utility functions for data processing in robot applications."""

import numpy as np
from typing import List, Optional


def calculate_average(values: List[float]) -> Optional[float]:
    """
    Calculate average of a list of values.

    Args:
        values: List of numeric values

    Returns:
        Average value or None if list is empty
    """
    if not values:
        return None

    return sum(values) / len(values)

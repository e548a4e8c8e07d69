"""The same function, written as a list of cases."""


def safe_speed(wanted, distance, stop_distance=0.5, slow_distance=1.5):
    """Return the allowed speed."""
    sensible = stop_distance >= 0.0 and slow_distance > stop_distance
    if not sensible:
        raise ValueError("the distances do not make sense")
    unknown = distance is None or distance != distance
    if not wanted > 0.0:
        return wanted
    if unknown or distance <= stop_distance:
        return 0.0
    if distance < slow_distance:
        span = slow_distance - stop_distance
        return (distance - stop_distance) * wanted / span
    return wanted

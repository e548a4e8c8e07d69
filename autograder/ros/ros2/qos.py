"""The QoS options of `topic pub` and `topic echo`, and the profiles that they select."""

from __future__ import annotations

import argparse
import copy

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import (
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSLivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    QoSReliabilityPolicy,
)

_POLICIES = {
    "history": QoSHistoryPolicy,
    "reliability": QoSReliabilityPolicy,
    "durability": QoSDurabilityPolicy,
    "liveliness": QoSLivelinessPolicy,
}


def add_qos_arguments(parser: argparse.ArgumentParser, entity: str, default: str) -> None:
    """Add the QoS options. `entity` is "subscribe" or "publish", and `default` is the default preset profile."""
    parser.add_argument(
        "--qos-profile",
        choices=QoSPresetProfiles.short_keys(),
        default=default,
        help=f"Quality of service preset profile to {entity} with (default: {default})",
    )
    parser.add_argument("--qos-depth", metavar="N", type=int, help=f"Queue size setting to {entity} with")
    for name, policy in _POLICIES.items():
        parser.add_argument(
            f"--qos-{name}",
            choices=policy.short_keys(),
            help=f"Quality of service {name} setting to {entity} with (default: the profile's)",
        )
    parser.add_argument(
        "--qos-liveliness-lease-duration-seconds",
        type=float,
        help=f"Quality of service liveliness lease duration to {entity} with, in seconds",
    )


def chosen_profile(args: argparse.Namespace) -> QoSProfile:
    """Return the preset profile that the user chose, changed by the user's other options."""
    profile: QoSProfile = copy.copy(QoSPresetProfiles.get_from_short_key(args.qos_profile))
    if args.qos_depth is not None:
        profile.depth = args.qos_depth
    for name, policy in _POLICIES.items():
        key = getattr(args, f"qos_{name}")
        if key is not None:
            setattr(profile, name, policy.get_from_short_key(key))
    if args.qos_liveliness_lease_duration_seconds is not None:
        profile.liveliness_lease_duration = Duration(seconds=args.qos_liveliness_lease_duration_seconds)
    return profile


def subscription_profile(node: Node, topic: str, args: argparse.Namespace) -> QoSProfile:
    """Return the user's profile. If it was not changed, return one that is compatible with every publisher."""
    profile = chosen_profile(args)
    names = ("depth", *_POLICIES, "liveliness_lease_duration_seconds")
    publishers = node.get_publishers_info_by_topic(topic)
    if not publishers or any(getattr(args, f"qos_{name}") is not None for name in names):
        return profile
    offered_profiles = [info.qos_profile for info in publishers]
    reliable_flags = [qos.reliability == QoSReliabilityPolicy.RELIABLE for qos in offered_profiles]
    durable_flags = [qos.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for qos in offered_profiles]
    profile.reliability = QoSReliabilityPolicy.RELIABLE if all(reliable_flags) else QoSReliabilityPolicy.BEST_EFFORT
    profile.durability = QoSDurabilityPolicy.TRANSIENT_LOCAL if all(durable_flags) else QoSDurabilityPolicy.VOLATILE
    for flags, best, fallback in (
        (reliable_flags, "QoSReliabilityPolicy.RELIABLE", "QoSReliabilityPolicy.BEST_EFFORT"),
        (durable_flags, "QoSDurabilityPolicy.TRANSIENT_LOCAL", "QoSDurabilityPolicy.VOLATILE"),
    ):
        if any(flags) and not all(flags):
            print(
                f"Some, but not all, publishers are offering {best}. "
                f"Falling back to {fallback} as it will connect to all publishers"
            )
    return profile

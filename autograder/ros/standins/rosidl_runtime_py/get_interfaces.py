"""The installed interfaces, from the ament index (stand-in for `rosidl_runtime_py.get_interfaces`)."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ament_index_python import get_package_share_directory, get_resource, get_resources, has_resource

_RESOURCE = "rosidl_interfaces"
_KINDS = ("msg", "srv", "action")


def get_all_interface_packages() -> dict[str, str]:
    """Return each package that has interfaces, and the prefix in which it is installed."""
    return dict(get_resources(_RESOURCE))


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the interfaces of the given packages, of all by default, such as `msg/String`.

    Raises:
        LookupError: a package is not installed or has no interfaces.
    """
    names = list(package_names) or list(get_resources(_RESOURCE))
    for name in names:
        if not has_resource("packages", name) and not has_resource(_RESOURCE, name):
            raise LookupError(f"Unknown package '{name}'")
        if not has_resource(_RESOURCE, name):
            raise LookupError(f"Package '{name}' has no interfaces")
    return {name: _interfaces_in(name) for name in names}


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages of the given packages; arguments and errors are those of `get_interfaces`."""
    return _interfaces_of_kind("msg", package_names)


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the services of the given packages; arguments and errors are those of `get_interfaces`."""
    return _interfaces_of_kind("srv", package_names)


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the actions of the given packages; arguments and errors are those of `get_interfaces`."""
    return _interfaces_of_kind("action", package_names)


def get_interface_packages() -> dict[str, str]:
    """Return each package that has interfaces, and its prefix."""
    return get_all_interface_packages()


def get_interface_path(interface_name: str) -> str:
    """Return the path of the `.msg`, `.srv` or `.action` file of `package/kind/Name`.

    Raises:
        ValueError: the name does not have the form `package/Name` or `package/kind/Name`.
        LookupError: the package or the interface is not installed.
    """
    parts = interface_name.split("/")
    if len(parts) < 2:
        raise ValueError(f"Invalid name '{interface_name}'. Expected three parts separated by '/'")
    if not all(parts):
        raise ValueError(f"Invalid name '{interface_name}'. Must not contain empty parts")
    if ".." in parts:
        raise ValueError(f"Invalid name '{interface_name}'. Must not contain '..'")
    try:
        share = Path(get_package_share_directory(parts[0]))
    except LookupError:
        raise LookupError(f"Unknown package '{parts[0]}'") from None
    relative_parts = parts[1:]
    folders = [relative_parts] if len(relative_parts) > 1 else [[kind, *relative_parts] for kind in _KINDS]
    for folder in folders:
        path = share.joinpath(*folder)
        candidates = [path] if path.suffix else [path.with_suffix(f".{folder[0]}"), path.with_suffix(".idl")]
        for candidate in candidates:
            if candidate.is_file():
                return str(candidate)
    raise LookupError(f"Could not find the interface '{share.joinpath(*folders[0]).with_suffix('.idl')}'")


def _interfaces_of_kind(kind: str, package_names: Iterable[str]) -> dict[str, list[str]]:
    interfaces = {
        package: [name for name in names if name.startswith(f"{kind}/")]
        for package, names in get_interfaces(package_names).items()
    }
    return {package: names for package, names in interfaces.items() if names}


def _interfaces_in(package: str) -> list[str]:
    content, _ = get_resource(_RESOURCE, package)
    # Most interfaces are listed twice, as source (.msg) and as generated .idl, and some only as .idl.
    return sorted(
        {line.rsplit(".", 1)[0] for line in content.splitlines() if line.rpartition(".")[2] in {*_KINDS, "idl"}}
    )

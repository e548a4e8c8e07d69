"""Compares setup.py with package.xml, which both describe a package, and checks the manifests of interface packages."""

from __future__ import annotations

from collections.abc import Mapping
from email.utils import parseaddr
from pathlib import Path

from autograder.harness import Workspace
from autograder.probes.colcon_test import runs_pytest
from autograder.probes.installed import INDEX, Installed
from autograder.probes.manifest import Manifest
from autograder.submission.packages import MANIFEST
from autograder.suite import expect

GENERATORS, RUNTIME = "rosidl_default_generators", "rosidl_default_runtime"
INTERFACE_GROUP = "rosidl_interface_packages"


def licence(installed: Installed) -> str:
    """Return the licence that setup.py declares."""
    return installed.metadata.get("License-Expression", installed.metadata.get("License", ""))


def expect_same_facts(installed: Installed, manifest: Manifest, fraction: float = 0.0) -> None:
    """Fail the check unless setup.py and package.xml agree about the package."""
    expect(bool(installed.metadata), f"setup.py does not give the name {installed.package}.", fraction=fraction)
    emails = [email for _, email in manifest.maintainers]
    address = parseaddr(installed.metadata.get("Maintainer-email", ""))[1]
    facts = (
        ("version", installed.metadata.get("Version", ""), [manifest.version]),
        ("licence", licence(installed), list(manifest.licences)),
        ("maintainer's e-mail", address, emails),
    )
    differences = [(label, value, allowed) for label, value, allowed in facts if not value or value not in allowed]
    clauses = "; ".join(
        f"the {label} is {value or 'missing'} in setup.py, {', '.join(allowed)} in package.xml"
        for label, value, allowed in differences
    )
    expect(not differences, f"The two files differ: {clauses}.", fraction=fraction)


def expect_installs_itself(installed: Installed) -> None:
    """Fail the check unless setup.py installs the package's marker and manifest. Each gives half of the points."""
    required = (INDEX / installed.package, Path("share", installed.package, MANIFEST))
    missing = [str(path) for path in required if str(path) not in installed.recorded]
    expect(
        not missing,
        f"setup.py does not install {' and '.join(missing)}. colcon still does it for you, but warns that "
        "it will not do so for ever.",
        fraction=0.5 * (2 - len(missing)),
    )


def expect_pytest(workspace: Workspace, installed: Installed, fraction: float = 0.0) -> None:
    """Fail the check unless setup.py names pytest in a way that `colcon test` recognises."""
    expect(
        runs_pytest(workspace, installed),
        "`colcon test` does not run pytest for this package, because setup.py does not require pytest for its "
        "tests: add extras_require={'test': ['pytest']}.",
        fraction=fraction,
    )


def wrong_for_interfaces(manifest: Manifest, uses: Mapping[str, str]) -> list[str]:
    """Return the mistakes in the manifest of an interface package, as clauses.

    `uses` maps each package that its definitions use to the name of such a definition.
    """
    mistakes = []
    if manifest.build_type != "ament_cmake":
        mistakes.append(f"the build type is {manifest.build_type or 'not given'}, but it should be ament_cmake")
    for tool in ("ament_cmake", GENERATORS):
        if tool not in manifest.needs("buildtool"):
            advice = f", but it is a build tool: the tag is <buildtool_depend>{tool}</buildtool_depend>"
            mistakes.append(f"{tool} is {f'declared{advice}' if tool in manifest.needs() else 'missing'}")
    if RUNTIME not in manifest.needs("exec"):
        mistakes.append(f"there is no <exec_depend>{RUNTIME}</exec_depend>, which users of the interfaces need")
    if INTERFACE_GROUP not in manifest.groups:
        mistakes.append(f"there is no <member_of_group>{INTERFACE_GROUP}</member_of_group>")
    for package, user in uses.items():
        if package not in manifest.needs("build") & manifest.needs("exec"):
            mistakes.append(f"{package}, which {user} uses, is not declared by <depend>")
    return mistakes

"""What the two files that describe a package say of it: setup.py against package.xml, and a manifest of interfaces."""

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
GROUP_OF_INTERFACES = "rosidl_interface_packages"


def licence(installed: Installed) -> str:
    """Return the licence that setup.py names."""
    return installed.metadata.get("License-Expression", installed.metadata.get("License", ""))


def expect_same_facts(installed: Installed, found: Manifest, fraction: float = 0.0) -> None:
    """Fail the check unless setup.py says the same of the package as package.xml does."""
    expect(bool(installed.metadata), f"setup.py does not give the name {installed.package}.", fraction=fraction)
    emails = [email for _, email in found.maintainers]
    address = parseaddr(installed.metadata.get("Maintainer-email", ""))[1]
    pairs = (
        ("version", installed.metadata.get("Version", ""), [found.version]),
        ("licence", licence(installed), list(found.licences)),
        ("maintainer's e-mail", address, emails),
    )
    wrong = [(what, said, wanted) for what, said, wanted in pairs if not said or said not in wanted]
    told = "; ".join(
        f"the {what} is {said or 'missing'} in setup.py, {', '.join(wanted)} in package.xml"
        for what, said, wanted in wrong
    )
    expect(not wrong, f"The two files differ: {told}.", fraction=fraction)


def expect_installs_itself(installed: Installed) -> None:
    """Fail the check unless setup.py installs the package's marker and manifest; half the points for one."""
    wanted = (INDEX / installed.package, Path("share", installed.package, MANIFEST))
    missing = [str(path) for path in wanted if str(path) not in installed.recorded]
    expect(
        not missing,
        f"setup.py does not install {' and '.join(missing)}. colcon still does it for you, and warns that it will not "
        "for ever.",
        fraction=0.5 * (2 - len(missing)),
    )


def expect_pytest(workspace: Workspace, installed: Installed, fraction: float = 0.0) -> None:
    """Fail the check unless setup.py names pytest in a way that colcon test sees."""
    expect(
        runs_pytest(workspace, installed),
        "`colcon test` does not run pytest for this package, because setup.py does not name pytest for its tests: "
        "extras_require={'test': ['pytest']} names it.",
        fraction=fraction,
    )


def wrong_for_interfaces(found: Manifest, uses: Mapping[str, str]) -> list[str]:
    """Return what is wrong in the manifest of a package of interfaces, in halves of sentences.

    `uses` has the packages that its definitions use, each with the name of one that does.
    """
    wrong = []
    if found.build_type != "ament_cmake":
        wrong.append(f"the build type is {found.build_type or 'not given'}, it should be ament_cmake")
    for tool in ("ament_cmake", GENERATORS):
        if tool not in found.needs("buildtool"):
            as_other = f", but a build tool: the tag is <buildtool_depend>{tool}</buildtool_depend>"
            wrong.append(f"{tool} is {f'there{as_other}' if tool in found.needs() else 'missing'}")
    if RUNTIME not in found.needs("exec"):
        wrong.append(f"there is no <exec_depend>{RUNTIME}</exec_depend>, which users of the interfaces need")
    if GROUP_OF_INTERFACES not in found.groups:
        wrong.append(f"there is no <member_of_group>{GROUP_OF_INTERFACES}</member_of_group>")
    for package, user in uses.items():
        if package not in found.needs("build") & found.needs("exec"):
            wrong.append(f"{package}, which {user} uses, is not declared by <depend>")
    return wrong

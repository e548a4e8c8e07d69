"""Starts a user's server from the release or the repository, in a ROS domain that no other user has."""

from __future__ import annotations

import grp
import os
import pwd
from pathlib import Path
from typing import Any

from jupyterhub.spawner import LocalProcessSpawner
from traitlets import Unicode

from autograder.ros.domains import DOMAINS, Domain
from autograder.ros.exceptions import NoFreeDomainError

SYSTEM_PATH = "/usr/local/bin:/usr/bin:/bin"


class NoServerError(Exception):
    """All ROS domains of this machine are in use. The hub shows the message to the user."""

    jupyterhub_message = (
        f"All {len(DOMAINS)} ROS domains of this machine are in use. A server that stops frees its domain: "
        "try again later, or ask your instructor."
    )


class CourseSpawner(LocalProcessSpawner):
    """Starts servers for users of this machine, with the course, ROS and nbgrader's exchange.

    All notebooks and terminals of a user share one ROS domain until the server stops. The hub claims it, and reclaims
    it when the hub is restarted. The user's programs outside the hub join it with `autograder ros`.
    """

    course = Unicode(help="The release that students run: a folder after `make setup`.").tag(config=True)
    repository = Unicode(help="The repository that teachers run.").tag(config=True)
    exchange = Unicode(help="nbgrader's exchange folder.").tag(config=True)
    teachers = Unicode(help="The group of this machine whose users are teachers.").tag(config=True)

    _domain: Domain | None = None

    async def start(self) -> Any:
        self.cmd = [str(self._folder / ".venv" / "bin" / "autograder"), "ros", "jupyterhub-singleuser"]
        self.claim_domain()
        try:
            return await super().start()
        except BaseException:
            self.release_domain()
            raise

    def get_env(self) -> dict[str, str]:
        env: dict[str, str] = super().get_env()
        # Servers do not inherit the hub's own PATH.
        env["PATH"] = os.pathsep.join([str(self._folder / ".venv" / "bin"), SYSTEM_PATH])
        settings = (self._folder / "jupyter", self._folder / "assets" / "students" / "jupyter")
        env["JUPYTER_CONFIG_PATH"] = os.pathsep.join(map(str, settings))
        env["NBGRADER_EXCHANGE"] = self.exchange
        if self._domain is not None:
            env["ROS_DOMAIN_ID"] = str(self._domain.number)
        return env

    def get_state(self) -> dict[str, Any]:
        state: dict[str, Any] = super().get_state()
        return state if self._domain is None else {**state, "ros_domain": self._domain.number}

    def load_state(self, state: dict[str, Any]) -> None:
        super().load_state(state)
        if (number := state.get("ros_domain")) is not None:
            self.claim_domain(int(number))

    def clear_state(self) -> None:
        super().clear_state()
        self.release_domain()

    @property
    def _folder(self) -> Path:
        is_teacher = self.user.name in grp.getgrnam(self.teachers).gr_mem
        return Path(self.repository if is_teacher else self.course)

    def claim_domain(self, number: int | None = None) -> None:
        """Claim the domain that the user already has, or a free one.

        Args:
            number: the domain of the user's running server, which is tried first.

        Raises:
            NoServerError: other users and programs use all domains.
        """
        try:
            first_index = None if number is None else DOMAINS.index(number)
            self._domain = Domain(first_index, user=pwd.getpwnam(self.user.name).pw_uid)
        except NoFreeDomainError as error:
            raise NoServerError(NoServerError.jupyterhub_message) from error

    def release_domain(self) -> None:
        """Release the domain for other users."""
        if self._domain is not None:
            self._domain.close()
            self._domain = None

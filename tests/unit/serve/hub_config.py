"""The configuration of the tests' hub: real, but for its proxy, which stands in front of nothing here."""

import os
from typing import Any

from jupyterhub.proxy import Proxy

SERVICE = "autograder"
HUB, PLACE, FOLDER = (os.environ[f"TEST_{name}"] for name in ("HUB", "SERVICE", "FOLDER"))


class Routes(Proxy):  # type: ignore[misc]
    """Notes the routes of a proxy. The tests ask hub and service at their own addresses."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self._routes: dict[str, dict[str, Any]] = {}

    async def add_route(self, routespec: str, target: str, data: dict[str, Any]) -> None:
        """Note a route."""
        self._routes[routespec] = {"routespec": routespec, "target": target, "data": data}

    async def delete_route(self, routespec: str) -> None:
        """Forget a route."""
        del self._routes[routespec]

    async def get_all_routes(self) -> dict[str, dict[str, Any]]:
        """Return what was noted."""
        return self._routes


c = get_config()  # type: ignore[name-defined]  # noqa: F821
c.JupyterHub.proxy_class = Routes
c.Routes.should_start = False
c.JupyterHub.hub_bind_url = HUB
c.JupyterHub.bind_url = f"{HUB}/"
c.JupyterHub.db_url = f"sqlite:///{FOLDER}/hub.sqlite"
c.JupyterHub.cookie_secret_file = f"{FOLDER}/cookie_secret"
c.JupyterHub.authenticator_class = "dummy"
c.DummyAuthenticator.allow_all = True
c.JupyterHub.services = [
    {
        "name": SERVICE,
        "url": PLACE,
        "api_token": os.environ["TEST_SERVICE_TOKEN"],
        "oauth_redirect_uri": f"{PLACE}/services/{SERVICE}/oauth_callback",
        "oauth_no_confirm": True,
    },
    {"name": "tests", "api_token": os.environ["TEST_ADMIN_TOKEN"]},
]
c.JupyterHub.load_roles = [
    {"name": "tests", "services": ["tests"], "scopes": ["admin:users", "tokens", "access:services"]},
    {"name": "user", "scopes": ["self", f"access:services!service={SERVICE}"]},
]

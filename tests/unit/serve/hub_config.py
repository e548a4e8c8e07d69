"""The configuration of the tests' hub. It has no proxy, because the tests connect to hub and service directly."""

import os
from typing import Any

from jupyterhub.proxy import Proxy

SERVICE = "autograder"
HUB, SERVICE_URL, FOLDER = (os.environ[f"TEST_{name}"] for name in ("HUB", "SERVICE", "FOLDER"))


class Routes(Proxy):
    """Keeps the routes of a proxy in memory, without a proxy."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._routes: dict[str, dict[str, Any]] = {}

    async def add_route(self, routespec: str, target: str, data: dict[str, Any]) -> None:
        """Keep a route."""
        self._routes[routespec] = {"routespec": routespec, "target": target, "data": data}

    async def delete_route(self, routespec: str) -> None:
        """Delete a route."""
        del self._routes[routespec]

    async def get_all_routes(self) -> dict[str, dict[str, Any]]:
        """Return all routes."""
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
        "url": SERVICE_URL,
        "api_token": os.environ["TEST_SERVICE_TOKEN"],
        "oauth_redirect_uri": f"{SERVICE_URL}/services/{SERVICE}/oauth_callback",
        "oauth_no_confirm": True,
    },
    {"name": "tests", "api_token": os.environ["TEST_ADMIN_TOKEN"]},
]
c.JupyterHub.load_roles = [
    {"name": "tests", "services": ["tests"], "scopes": ["admin:users", "tokens", "access:services"]},
    {"name": "user", "scopes": ["self", f"access:services!service={SERVICE}"]},
]

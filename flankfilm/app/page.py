"""The page's transport, by trame: one window for each connection, on this machine alone, by a secret address.

The only file that imports trame and what is under it, which are untyped.
"""

from __future__ import annotations

import asyncio
import hmac
import secrets
import sys
import webbrowser
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from aiohttp import web
from trame.app import get_server
from trame_client.widgets.core import AbstractElement
from trame_vuetify.ui.vuetify3 import VAppLayout
from wslink import register
from wslink.websocket import LinkProtocol

from flankfilm.app.scene_files import SceneFiles
from flankfilm.app.window import Tabs, Window
from flankfilm.files.folder import PAGE

__all__ = ["serve"]

HOST = "127.0.0.1"
"""The only interface that is listened on."""

WWW = Path(__file__).with_name("www")

FILES = {"scripts": ("charts.js", "results.js", "studies.js", "page.js"), "styles": ("page.css",)}

LOST = (
    "<p class='lost'>The connection to flankfilm is lost, and what this window started has ended. Load the page again, "
    "which continues with your edits; if nothing comes, start flankfilm again, and open the address that it prints.</p>"
)

THEME = {
    "defaultTheme": "system",
    "themes": {"dark": {"colors": {"primary": "#90caf9", "on-primary": "#000000", "error": "#ffb4ab"}}},
}
"""Light or dark as the system is; the dark one with text that is read easily."""

SECRET_BYTES = 32

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Windows(LinkProtocol):
    """Calls of the page; each connection has a separate window, which ends with it."""

    def __init__(self, files: SceneFiles, name: str) -> None:
        super().__init__()
        self._files, self._name = files, name
        self._windows: dict[str, Window] = {}
        self._tabs: Tabs = {}
        self.server: Any = None

    @register("flankfilm.call")
    def call(self, method: str, *arguments: str) -> dict[str, Any]:
        """Call a method of the window that asks; see `Window.call`."""
        client = self.server.last_active_client_id
        if client not in self._windows:
            tell = partial(self._tell, asyncio.get_running_loop(), client)
            self._windows[client] = Window(self._files, self._name, tell, self._tabs)
        return self._windows[client].call(method, *arguments)

    def onClose(self, client_id: str) -> None:
        """End what a window started, once it is closed."""
        if (window := self._windows.pop(client_id, None)) is not None:
            asyncio.get_running_loop().run_in_executor(None, window.close)

    def close(self) -> None:
        """End what all windows started."""
        for client in list(self._windows):
            self._windows.pop(client).close()

    def _tell(
        self, loop: asyncio.AbstractEventLoop, client: str, kind: str, content: Mapping[str, Any]
    ) -> None:
        """Send what came later to the window that it is for; called in any thread."""
        if not loop.is_closed():
            loop.call_soon_threadsafe(self._send, client, {"kind": kind, "content": dict(content)})

    def _send(self, client: str, message: dict[str, Any]) -> None:
        if client in self._windows:
            self.publish("flankfilm.told", message, client)


def serve(files: SceneFiles, name: str, port: int, show: bool) -> None:
    """Serve the page until the process is asked to end.

    Parameters
    ----------
    files : SceneFiles
    name : str
        Scene that a window opens with, from the folder of the files; empty for the template.
    port : int
        0 for any that is free.
    show : bool
        Whether to open the browser; the address is printed anyway.
    """
    windows, secret = Windows(files, name), secrets.token_urlsafe(SECRET_BYTES)
    try:
        asyncio.run(_serve(windows, files, secret, port, show))
    except SystemExit:
        pass  # how aiohttp answers a signal
    finally:
        windows.close()


async def _serve(windows: Windows, files: SceneFiles, secret: str, port: int, show: bool) -> None:
    server = get_server("flankfilm")
    server.client_type = "vue3"
    server.enable_module(
        {
            "serve": {"__flankfilm": str(WWW)},
            "vue_use": ["flankfilm"],
            **{kind: [f"__flankfilm/{file}" for file in names] for kind, names in FILES.items()},
        }
    )
    server.state.trame__title = "flankfilm"
    server.state.trame__template_error = LOST
    with VAppLayout(server, vuetify_config={"theme": THEME}):
        AbstractElement("flankfilm-page", trame_server=server)
    server.add_protocol_to_configure(lambda protocol: protocol.registerLinkProtocol(windows))

    def bound(listening: Any) -> None:
        windows.server = listening
        guard = _Guard(secret, files.root)
        listening.app.middlewares.append(guard.check)
        listening.app.router.add_get("/results/{path:.+}", guard.report)

    def ready(**_: Any) -> None:
        address = f"http://{HOST}:{server.port}/?secret={secret}"
        print(f"flankfilm: the page is at {address}", flush=True)
        if show:
            webbrowser.open(address)

    server.controller.on_server_bind.add(bound)
    server.controller.on_server_ready.add(ready)
    server.cli.set_defaults(authKey=secret, host=HOST, static_follow_symlinks=False)
    del sys.argv[1:]  # which trame would read
    await server.start(
        port=port,
        host=HOST,
        exec_mode="coroutine",
        thread=True,
        open_browser=False,
        show_connection_info=False,
        disable_logging=True,
        timeout=0,
    )


class _Guard:
    """Lets in who knows the secret address, from a page of this server alone.

    A browser keeps the secret in a cookie that no script reads and no other site's page sends, so that a page can be
    loaded again; the address without it is refused. A name that leads here (DNS) is refused by the host.
    """

    def __init__(self, secret: str, root: Path) -> None:
        self._secret, self._root = secret, root.resolve()

    @property
    def check(self) -> Any:
        """Middleware of every request."""

        @web.middleware
        async def checked(request: web.Request, handler: Handler) -> web.StreamResponse:
            here = f"{HOST}:{request.transport.get_extra_info('sockname')[1]}" if request.transport else ""
            if request.host != here or request.headers.get("Origin", f"http://{here}") != f"http://{here}":
                raise web.HTTPForbidden(text="not from this page")
            cookie = f"flankfilm-{here.rpartition(':')[2]}"
            asked = request.query.get("secret", "")
            if not any(self._is_secret(text) for text in (asked, request.cookies.get(cookie, ""))):
                raise web.HTTPForbidden(text="Open the address that flankfilm has printed.")
            if request.path in ("/", "/index.html") and "sessionURL" not in request.query:
                arguments = urlencode({"sessionURL": f"ws://{here}/ws", "secret": self._secret})
                raise web.HTTPFound(f"/index.html?{arguments}")
            response = await handler(request)
            if isinstance(response, web.WebSocketResponse):
                return response
            for name, text in HEADERS.items():
                response.headers.setdefault(name, text)
            if asked:
                response.set_cookie(cookie, self._secret, httponly=True, samesite="Strict")
            return response

        return checked

    async def report(self, request: web.Request) -> web.StreamResponse:
        """The report of a run below the folder; no other file."""
        path = (self._root / request.match_info["path"]).resolve()
        if path.name != PAGE or not path.is_relative_to(self._root) or not path.is_file():
            raise web.HTTPNotFound
        return web.FileResponse(path, headers={"Content-Security-Policy": SANDBOX})

    def _is_secret(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(), self._secret.encode())


HEADERS = {
    "Content-Security-Policy": (
        "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data:; font-src 'self' data:; frame-ancestors 'none'; base-uri 'self'; form-action 'none'"
    ),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}

SANDBOX = "sandbox allow-scripts allow-popups"
"""A report is a page without the rights of this one: it reads no cookie and calls nothing here."""

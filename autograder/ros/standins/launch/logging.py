"""Where a launch's words go: its own to screen and `launch.log`, its processes' as each one asks.

The log folder is ``$ROS_LOG_DIR``, ``$ROS_HOME/log`` or ``~/.ros/log``, and in it one folder per launch.
"""

from __future__ import annotations

import logging
import os
import socket
import sys
from collections.abc import Iterable, Mapping
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from standin_notice import guard

_LOG_FORMAT = "{created:.7f} [{levelname}] [{name}]: {message}"
_SCREEN_FORMATS = {
    "default": "[{levelname}] [{name}]: {message}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {message}",
}
if TYPE_CHECKING:
    _StreamHandler = logging.StreamHandler[Any]
else:
    _StreamHandler = logging.StreamHandler  # not generic before Python 3.11
OutputConfig = Mapping[str, "str | Iterable[str]"]


class _ScreenHandler(_StreamHandler):
    """Writes to what is standard output at the time, which notebooks and tests exchange."""

    def __init__(self, format_: str) -> None:
        logging.Handler.__init__(self)
        self.setFormatter(logging.Formatter(format_, style="{"))

    @property
    def stream(self) -> Any:
        return sys.stdout


class _LogFileHandler(logging.FileHandler):
    """Writes to a file of this launch."""


def _base_directory() -> Path:
    directory = os.environ.get("ROS_LOG_DIR")
    if not directory:
        directory = str(Path(os.environ.get("ROS_HOME") or "~/.ros") / "log")
    return Path(directory).expanduser()


class LaunchConfig:
    """The settings of the launch's logging; there is one, `launch_config`."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget the log folder and the files in it, and return to the default format."""
        for handler in getattr(self, "_files", {}).values():
            handler.close()
        self._log_dir: Path | None = None
        self._files: dict[str, logging.Handler] = {}
        self.log_file_name = "launch.log"
        self.level = logging.INFO
        self.set_screen_format("default")

    def set_screen_format(self, screen_format: str) -> None:
        """Set the format of the screen: 'default', 'default_with_timestamp' or a format in braces style."""
        chosen = os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT") or screen_format
        self.screen_handler = _ScreenHandler(_SCREEN_FORMATS.get(chosen, chosen))

    @property
    def log_dir(self) -> str:
        """The folder of this launch's log files, made when first asked for."""
        if self._log_dir is None:
            base = _base_directory()
            stamp = datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
            self._log_dir = base / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
            self._log_dir.mkdir(parents=True)
            _point_latest_at(self._log_dir)
        return str(self._log_dir)

    @log_dir.setter
    def log_dir(self, log_dir: str) -> None:
        if not Path(log_dir).is_dir():
            raise ValueError(f"{log_dir} is not a directory")
        self._log_dir = Path(log_dir)

    def get_log_file_path(self, file_name: str = "launch.log") -> str:
        """Return the path of a log file of this launch."""
        return str(Path(self.log_dir) / file_name)

    def get_log_file_handler(self, file_name: str, format_: str) -> logging.Handler:
        """Return the handler that writes to a log file in a format, the same each time."""
        key = f"{file_name} {format_}"
        if key not in self._files:
            handler = _LogFileHandler(self.get_log_file_path(file_name), encoding="utf-8", delay=True)
            handler.setFormatter(logging.Formatter(format_, style="{"))
            self._files[key] = handler
        return self._files[key]


def _point_latest_at(log_dir: Path) -> None:
    """Let ``latest`` point at `log_dir`; two launches may do so at once, then either is right."""
    temporary = log_dir.with_name(f"{log_dir.name}.latest")
    temporary.symlink_to(log_dir, target_is_directory=True)
    latest = log_dir.with_name("latest")
    if latest.is_dir() and not latest.is_symlink():
        temporary.unlink()
    else:
        temporary.replace(latest)


launch_config = LaunchConfig()


def reset() -> None:
    """Return the logging of the launch to its defaults."""
    launch_config.reset()


def _set_handlers(logger: logging.Logger, handlers: list[logging.Handler]) -> None:
    """Give `logger` our `handlers` in place of ours from an earlier launch; leave other people's alone."""
    others = [h for h in logger.handlers if not isinstance(h, (_ScreenHandler, _LogFileHandler))]
    logger.handlers[:] = [*others, *handlers]


def get_logger(name: str | None = None) -> logging.Logger:
    """Return the named logger; it writes to the screen and to the launch's main log file."""
    logger = logging.getLogger(name)
    main_file = launch_config.get_log_file_handler(launch_config.log_file_name, _LOG_FORMAT)
    _set_handlers(logger, [launch_config.screen_handler, main_file])
    if logger is not logging.root:
        logger.propagate = False
        logger.setLevel(launch_config.level)
    return logger


_NAMED_OUTPUTS: dict[str, dict[str, set[str]]] = {
    "screen": {"both": {"screen"}},
    "log": {"both": {"log"}, "stderr": {"screen"}},
    "both": {"both": {"log", "screen"}},
    "own_log": {"both": {"own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
    "full": {"both": {"screen", "log", "own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
}


def _normalized(output: str | OutputConfig) -> dict[str, set[str]]:
    """Return, for stdout, stderr and both, the set of places that `output` names."""
    if isinstance(output, str):
        if output not in _NAMED_OUTPUTS:
            raise ValueError(f'{output} is not a valid standard output config i.e. "screen", "log" or "both"')
        return {source: set(_NAMED_OUTPUTS[output].get(source, ())) for source in ("both", "stdout", "stderr")}
    wanted: dict[str, set[str]] = {"both": set(), "stdout": set(), "stderr": set()}
    for source, places in output.items():
        if source not in wanted:
            raise ValueError(f'{source} is not a valid output source i.e. "stdout", "stderr" or "both"')
        names = {places} if isinstance(places, str) else set(places)
        if not names <= {"screen", "log", "own_log"}:
            raise ValueError(f'{sorted(names)} is not a valid output destination i.e. "screen", "log" or "own_log"')
        wanted[source] = names
    return wanted


def get_output_loggers(process_name: str, output: str | OutputConfig) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of a process's standard output and standard error.

    `output` is 'screen', 'log' (everything to the log file, errors to the screen too), 'both', 'own_log' or
    'full', or a mapping from 'stdout', 'stderr' or 'both' to 'screen', 'log', 'own_log' or several of them.
    Raises ValueError for anything else.
    """
    wanted = _normalized(output)
    loggers = []
    for source in ("stdout", "stderr"):
        logger = logging.getLogger(f"{process_name}-{source}")
        logger.propagate = False
        logger.setLevel(logging.INFO)
        handlers: list[logging.Handler] = []
        if "screen" in wanted["both"] | wanted[source]:
            handlers.append(_ScreenHandler("{message}"))
        if "log" in wanted["both"] | wanted[source]:
            handlers.append(launch_config.get_log_file_handler(launch_config.log_file_name, "{created:.7f} {message}"))
        if "own_log" in wanted[source]:
            handlers.append(launch_config.get_log_file_handler(f"{process_name}-{source}.log", "{message}"))
        if "own_log" in wanted["both"]:
            handlers.append(launch_config.get_log_file_handler(f"{process_name}.log", "{message}"))
        _set_handlers(logger, handlers)
        loggers.append(logger)
    return loggers[0], loggers[1]


def log_launch_config(*, logger: logging.Logger) -> None:
    """Tell where the log files are and how much is logged."""
    logger.info("All log files can be found below %s", launch_config.log_dir)
    logger.info("Default logging verbosity is set to %s", logging.getLevelName(logger.getEffectiveLevel()))


__getattr__ = guard(__name__)

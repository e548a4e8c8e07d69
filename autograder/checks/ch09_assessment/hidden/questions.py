"""The key to question 1: the right letter of each choice, and why the other ones are wrong."""

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
        right: the right letter.
        wrong: for each other letter, why it is wrong, without naming the right one.
        hints: shown one after the other if the answer is wrong.
        doc: a page to read.
    """

    objective: str
    title: str
    right: str
    wrong: Mapping[str, str]
    hints: tuple[str, str]
    doc: str


QUESTIONS = {
    "q1": Question(
        "structure",
        "What setup.py is for.",
        "b",
        {
            "a": "No line of setup.py has to do with C++: a C++ package has a CMakeLists.txt, and no setup.py.",
            "c": "Runtime dependencies are what package.xml names, and rosdep reads no other file; setup.py's "
            "install_requires is for pip, which has no part in a colcon build. And setup.py does far more than that.",
            "d": "Messages are .msg files of an interface package; its CMakeLists.txt has the code for them generated.",
        },
        ("Open a setup.py of the course: which keywords does setup() take?", "Who reads it: rosdep, colcon or CMake?"),
        f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html",
    ),
    "q2": Question(
        "structure",
        "A program that was built, and that ros2 run does not find.",
        "c",
        {
            "a": "A dependency in package.xml has something installed; it does not say where your own programs go.",
            "b": "Without an entry point there would be no bin/driver at all: this one was made.",
            "d": "Without the marker ros2 run would say that the package is not found. It found the package.",
        },
        ("Where does ros2 run look, and where does Python put programs by itself?", "One of the files has two lines."),
        f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html",
    ),
    "q3": Question(
        "nodes",
        "A module that is in src and not in the install space.",
        "a",
        {
            "b": "package.xml names packages of other people; my_robot.nodes is a part of your own.",
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
            "a": "SIGTERM raises ExternalShutdownException, which nothing catches here; and after Ctrl-C the signal "
            "handler has shut the context down already, so that shutdown() raises.",
            "b": "This takes every bug for a regular end, too; and after Ctrl-C shutdown() still raises.",
            "c": "spin() does not return then: it raises, so that destroy_node() is never reached.",
        },
        ("Two signals, two exceptions: which?", "Who has shut the context down when finally is reached?"),
        f"{_DOCS}/p/rclpy/api/init_shutdown.html",
    ),
    "q5": Question(
        "client-library",
        "A subscription that asks for more than is offered.",
        "b",
        {
            "a": "Nothing is sent twice to become reliable: the two ends do not match, and then exchange nothing.",
            "c": "Incompatible quality of service is no exception: the node runs on, with a warning in its log.",
            "d": "Each match delivers a message once. Here there is not even one match.",
        },
        ("A depth alone, 10, stands for a profile: reliable or best effort?", "Requested must not exceed offered."),
        f"{_DOCS}/Concepts/Intermediate/About-Quality-of-Service-Settings.html",
    ),
    "q6": Question(
        "client-library",
        "A service that is called from within a callback.",
        "a",
        {
            "b": "Between two programs of which one spins elsewhere it would be so. Who takes the answer here?",
            "c": "rclpy does not look who calls, and raises nothing: it waits.",
            "d": "The request is sent and answered. The answer arrives, and somebody would have to take it.",
        },
        ("How many threads does rclpy.spin() have?", "call() waits; what does it wait for, and who would do that?"),
        f"{_DOCS}/How-To-Guides/Sync-Vs-Async.html",
    ),
    "q7": Question(
        "interfaces",
        "Where message definitions live.",
        "c",
        {
            "a": "data_files copies the text. No import finds a text file: code has to be generated from it.",
            "b": "A class of your own is no message: no tool, no other language and no recording knows it.",
            "d": "<export> takes the build type and the like; a definition is a file of its own.",
        },
        ("Which build type runs the generators?", "Two packages of one name clash."),
        f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html",
    ),
    "q8": Question(
        "interfaces",
        "Which kind of interface fits a long job.",
        "d",
        {
            "a": "A message on a topic has no answer: the caller would never know whether the job was taken.",
            "b": "A service answers once, at the end; there is no word on the way, and nothing to call back.",
            "c": "A parameter configures a node; it knows neither progress nor an end.",
        },
        ("Goal, feedback, result.", "Which of the four is made of three parts?"),
        f"{_DOCS}/Concepts/Basic/About-Actions.html",
    ),
    "q9": Question(
        "build-and-test",
        "What the exit status of colcon test says.",
        "a",
        {
            "b": "By default it ends with 0 also when a test has failed, and when none was found.",
            "c": "colcon measures no coverage unless it is told to.",
            "d": "colcon test builds nothing: it tests what the last colcon build left.",
        },
        ("Break a test on purpose, run colcon test, then echo $?.", "Which verb of colcon counts failures?"),
        "https://colcon.readthedocs.io/en/released/reference/verb/test-result.html",
    ),
    "q10": Question(
        "build-and-test",
        "A test that looks too early.",
        "d",
        {
            "a": "pytest runs ROS nodes like any other Python code; the course's own tests do.",
            "b": "A message made by hand is as good as a lidar's, and better for a test: it is the same each time.",
            "c": "Two profiles that do not match would be a reason in another test; here they are the same.",
        },
        ("When does a callback run?", "What stands between publish() and assert in the tests of 06_testing?"),
        f"{_DOCS}/Concepts/Intermediate/About-Executors.html",
    ),
    "q11": Question(
        "best-practices",
        "A reading of a lidar that is no measurement.",
        "b",
        {
            "a": "A reading's place in the list is its bearing: what comes after the gap would point elsewhere.",
            "c": "range_max says that the way is free so far. Nobody measured that.",
            "d": "0.0 is no distance that a lidar measures, and a minimum over the list would take it for a wall.",
        },
        ("What else does a reading have besides its value?", "REP 117 has a word for `not known`."),
        "https://www.ros.org/reps/rep-0117.html",
    ),
    "q12": Question(
        "best-practices",
        "An exception that is expected, and those that are not.",
        "c",
        {
            "a": "A misspelt name raises, too, and would be logged for ever by a node that looks alive.",
            "b": "Then every hiccup of the sensor ends the node, although somebody knew that it would come.",
            "d": "This hides even the end of the program from itself: KeyboardInterrupt is a BaseException.",
        },
        ("Which exceptions do you expect, by name?", "Who listens downstream, and what should they hear?"),
        "https://docs.python.org/3/tutorial/errors.html",
    ),
}

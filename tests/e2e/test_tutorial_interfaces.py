"""The interface packages of ROS's tutorials are installed by set-up, with the same types as the real ones."""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor

from autograder.building.interfaces import tutorials
from autograder.ros import activate

# The type's hash (REP 2011), as `ros2 service info --verbose` of Jazzy shows it.
ADD_TWO_INTS = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"


@pytest.fixture(scope="module")
def prefix() -> Path:
    ros = activate()
    if ros.kind != "wheels":
        pytest.skip("a sourced ROS has its own")
    return ros.prefixes[0]


@pytest.mark.promise("Their types have the hashes of the real ones")
def test_an_interface_type_has_the_hash_of_the_real_package(prefix: Path) -> None:
    described = json.loads((prefix / "share/example_interfaces/srv/AddTwoInts.json").read_text())
    hashes = {entry["type_name"]: entry["hash_string"] for entry in described["type_hashes"]}
    assert hashes["example_interfaces/srv/AddTwoInts"] == ADD_TWO_INTS


def test_each_definition_becomes_a_class(prefix: Path) -> None:
    for package, files in tutorials.packages().items():
        for path in files:
            kind, name = path.rsplit(".", 1)[0].split("/")
            module = __import__(f"{package}.{kind}", fromlist=[name])
            assert getattr(module, name)


def test_a_server_answers_a_client(prefix: Path, ros_domain: int) -> None:
    from example_interfaces.srv import AddTwoInts

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = rclpy.create_node("sums", context=context)
    node.create_service(AddTwoInts, "add_two_ints", add)
    client = node.create_client(AddTwoInts, "add_two_ints")
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        future = client.call_async(AddTwoInts.Request(a=41, b=1))
        executor.spin_until_future_complete(future, timeout_sec=60.0)
        assert future.done()
        assert future.result().sum == 42
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()


def test_an_installed_interface_package_is_not_built_again(prefix: Path) -> None:
    assert tutorials.install(prefix) == []


@pytest.mark.promise("Set-up builds them for Python programs")
def test_a_missing_package_is_built_and_a_loaded_library_is_never_written_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packages = {"action_tutorials_interfaces": tutorials.packages()["action_tutorials_interfaces"]}
    monkeypatch.setattr(tutorials, "packages", lambda: packages)
    assert tutorials.install(tmp_path) == ["action_tutorials_interfaces"]
    assert tutorials.install(tmp_path) == []
    installed = next((tmp_path / "lib").glob("*.so"))
    (tmp_path / "share/action_tutorials_interfaces/action/Fibonacci.action").write_text("another definition\n")
    with installed.open("rb") as library:
        assert tutorials.install(tmp_path) == ["action_tutorials_interfaces"]
        assert os.fstat(library.fileno()).st_nlink == 0  # the installed library is a new file
    python = "python{}.{}".format(*sys.version_info)
    assert (tmp_path / "lib" / python / "site-packages/action_tutorials_interfaces/action/__init__.py").is_file()


def test_without_a_compiler_the_set_up_says_how_to_install_interface_packages_later(
    prefix: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ros = activate()
    monkeypatch.setattr(tutorials, "find", lambda: ros)
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    assert tutorials.main() == 0
    output = capsys.readouterr().out
    assert "g++ is missing" in output
    assert "-m autograder.building.interfaces.tutorials" in output

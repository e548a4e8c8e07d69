"""The public submodules of the real packages, for programs that import a name from the module that defines it.

The modules of the stand-ins are different. So `launch.actions.group_action` is a module with the names of
`launch.actions`. Importing a submodule that no stand-in covers, such as `launch_testing.decorator`, raises an error.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

from standin_notice import not_covered

# The submodules of each module in Jazzy's packages.
SUBMODULES = {
    "launch": "invalid_launch_file_error some_entities_type some_substitutions_type",
    "launch.actions": (
        "append_environment_variable declare_launch_argument emit_event group_action log_info opaque_coroutine "
        "pop_environment pop_launch_configurations push_environment push_launch_configurations register_event_handler "
        "reset_environment reset_launch_configurations set_environment_variable set_launch_configuration "
        "shutdown_action unregister_event_handler unset_environment_variable unset_launch_configuration"
    ),
    "launch.conditions": (
        "evaluate_condition_expression_impl if_condition invalid_condition_expression_error "
        "launch_configuration_equals launch_configuration_not_equals unless_condition"
    ),
    "launch.descriptions": "executable",
    "launch.event_handlers": (
        "event_named on_action_event_base on_execution_complete on_include_launch_description on_process_exit "
        "on_process_io on_process_start on_shutdown"
    ),
    "launch.events": "execution_complete include_launch_description shutdown timer_event",
    "launch.events.process": (
        "process_exited process_io process_matchers process_started process_stderr process_stdin process_stdout "
        "process_targeted_event running_process_event shutdown_process signal_process"
    ),
    "launch.launch_description_sources": (
        "any_launch_description_source any_launch_file_utilities frontend_launch_description_source "
        "frontend_launch_file_utilities python_launch_description_source python_launch_file_utilities"
    ),
    "launch.logging": "handlers",
    "launch.substitutions": (
        "anon_name boolean_substitution command environment_variable equals_substitution file_content find_executable "
        "if_else_substitution launch_configuration launch_log_dir local_substitution not_equals_substitution "
        "path_join_substitution python_expression substitution_failure text_substitution this_launch_file "
        "this_launch_file_dir"
    ),
    "launch.utilities": (
        "class_tools_impl ensure_argument_type_impl normalize_to_list_of_entities_impl "
        "normalize_to_list_of_substitutions_impl perform_substitutions_impl signal_management typing_file_path "
        "visit_all_entities_and_collect_futures_impl"
    ),
    "launch_testing.actions": "ready",
    "launch_testing.asserts": "assert_exit_codes assert_output assert_sequential_output",
    "launch_testing.event_handlers": "stdout_ready_listener",
    "launch_xml.launch_description_sources": "xml_launch_description_source",
    "launch_yaml.launch_description_sources": "yaml_launch_description_source",
    "launch_ros": "parameters_type remap_rule_type",
    "launch_ros.actions": (
        "composable_node_container load_composable_nodes push_ros_namespace "
        "set_parameter set_parameters_from_file set_remap set_ros_log_dir set_use_sim_time"
    ),
    "launch_ros.descriptions": "composable_node",
    "launch_ros.substitutions": "executable_in_package find_package parameter",
    "launch_ros.utilities": (
        "evaluate_parameters namespace_utils normalize_parameters normalize_remap_rule plugin_support "
        "to_parameters_list track_node_names"
    ),
}
# The submodules of the real packages that the stand-ins do not cover.
NOT_COVERED = {
    "launch_ros": "event_handlers events ros_adapters",
    "launch_ros.actions": "lifecycle_node lifecycle_transition ros_timer",
    "launch_testing": (
        "decorator junitxml launch_test legacy parametrize parse_arguments pytest ready_to_test_action_timeout"
    ),
    "launch_testing.actions": "gtest pytest test",
    "launch_testing.tools": "output process text",
    "launch_pytest": "fixture",
    "ament_copyright": "copyright_names crawler licenses parser",
}


class _SubmoduleFinder(MetaPathFinder, Loader):
    """The last finder in `sys.meta_path`: finds submodules for which the stand-ins have no file."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        parent, _, name = fullname.rpartition(".")
        if name in SUBMODULES.get(parent, "").split():
            return ModuleSpec(fullname, self)
        if name in NOT_COVERED.get(parent, "").split():
            raise not_covered(fullname, standin=fullname.partition(".")[0])
        return None

    def exec_module(self, module: ModuleType) -> None:
        parent = vars(sys.modules[module.__name__.rpartition(".")[0]])
        names = {name for name in parent if not name.startswith("__")} | ({"__getattr__"} & set(parent))
        module.__dict__.update({name: parent[name] for name in names})


_FINDER = _SubmoduleFinder()


def install_submodule_finder() -> None:
    """Let programs import the real packages' submodules; importing one that is not covered raises an error."""
    if _FINDER not in sys.meta_path:
        sys.meta_path.append(_FINDER)

"""Next steps for errors about names: attributes that a module lacks, and where they are defined."""

from __future__ import annotations

import ast
import dis
import os
import pkgutil
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from enum import EnumType
from importlib import import_module
from types import CodeType, FrameType, FunctionType, MethodType, ModuleType

from graphflow.analysis.syntax import last_name, nodes_in, syntax_of
from graphflow.analysis.user_code import is_ours, is_users, short_place
from graphflow.msgs import registry
from graphflow.msgs.homes import homes, imports
from graphflow.msgs.registry import KINDS
from graphflow.names import nearest
from graphflow.rclpy.hints.frames import PATH, line_of, named, own
from graphflow.runtime.mistakes.errors.name_errors import MODULES, unbound_local
from graphflow.system import SITE


def missing_name(error: BaseException, _frames: list[FrameType]) -> str:
    """Name the module that does define an imported name."""
    found = re.match(r"cannot import name '(\w+)' from '([\w.]+)'", str(error))
    if not isinstance(error, ImportError) or found is None:
        return ""
    name, module = found.groups()
    return _where(name, module)


def _where(name: str, module: str) -> str:
    """Describe the location of a name that a module lacks."""
    package, _, kind = module.partition(".")
    if kind in KINDS and package != "rclpy":  # which has a module `action`
        if " must be " in (wrong := registry.misplaced(package, name)):
            return wrong.removeprefix("; ")
        known = sorted(homes(name), key=lambda where: not where.startswith(f"{package}."))
        if known:
            return f"{name} is in {' and '.join(known[:3])}: from {known[0]} import {name}"
        near = nearest(name, registry.names_in(package, kind))
        return f"did you mean {near!r}?" if near is not None else ""
    if package in registry.packages():
        if name in KINDS and not kind:
            return f"write import {module}.{name}"
        kinds = [kind for kind in KINDS if name in registry.names_in(package, kind)]
        return f"{name} is in {package}.{kinds[0]}: from {package}.{kinds[0]} import {name}" if kinds else ""
    way = _in_rclpy(name, module) if package == "rclpy" else ""
    if way or module not in sys.modules or not is_ours(str(sys.modules[module].__file__)):
        return way
    public = [word for word in dir(sys.modules[module]) if not word.startswith("_")]
    near = nearest(name, [*public, *getattr(sys.modules[module], "__all__", ())])
    return f"did you mean {near!r}?" if near is not None else ""


def _of_callback(path: str, name: str, frame: FrameType) -> str:
    """Name the object to use where a timer's or subscription's method was called on its callback."""
    owner, _, method = path.rpartition(".")
    thing = {**frame.f_globals, **frame.f_locals}.get(owner)
    kept = [
        attribute
        for attribute, value in getattr(thing, "__dict__", {}).items()
        if getattr(getattr(value, "callback", None), "__name__", "") == method
    ]
    way = (
        f"write {owner}.{kept[0]}.{name}()" if kept else f"keep the result of create_timer(...), and call its {name}()"
    )
    return f"{path} is a callback, which has no {name}: {way}"


def unknown_name(error: BaseException, frames: list[FrameType]) -> str:
    """Suggest the intended name for an unbound one, or for an attribute that a module or node lacks."""
    users = own(frames)
    if not users:
        return ""
    if isinstance(error, UnboundLocalError) and (way := unbound_local(error, users[-1])):
        return way
    if isinstance(error, NameError):
        found = re.search(r"(?:name|variable) '(\w+)'", str(error))
        return _unbound(found[1], users[-1]) if found is not None else ""
    if not isinstance(error, AttributeError) or error.name is None:
        return ""
    if isinstance(error.obj, ModuleType):
        return _where(error.name, error.obj.__name__)
    if isinstance(error.obj, tuple) and (path := _path_of(error.name, line_of(frames))):
        return _of_tuple(path, users[-1])
    if isinstance(error.obj, (FunctionType, MethodType)) and (path := _path_of(error.name, line_of(frames))):
        if error.name in ("cancel", "reset", "destroy"):
            return _of_callback(path, error.name, users[-1])
        return f"{path} is a function: call it, as in {path}().{error.name}"
    return _inside_method(error.name, type(error.obj))


def _of_tuple(path: str, frame: FrameType) -> str:
    """Explain why a name stands for a tuple, if the source shows that."""
    for node in nodes_in(syntax_of(frame.f_code.co_filename).module):
        match node:
            case ast.Assign(targets=[target], value=value) if ast.unparse(target) == path:
                if isinstance(value, ast.Tuple) and len(value.elts) == 1:
                    return f"{path} is a tuple because of the comma after its value: remove the comma"
                if isinstance(value, ast.Call) and last_name(value.func) == "wait_for_message":
                    return f"wait_for_message returns whether a message came, too: write ok, {path} = ..."
    return ""


def _inside_method(name: str, cls: type) -> str:
    """Show how to make an attribute of a function or variable that a class has only inside one of its methods."""
    for method in _functions(cls):
        inner = next((c for c in method.co_consts if isinstance(c, CodeType) and c.co_name == name), None)
        if inner is not None:
            place = short_place(inner.co_filename, inner.co_firstlineno)
            return f"{name} ({place}) is inside {method.co_name}: indent it like {method.co_name} itself"
    for method in _functions(cls):
        if name in method.co_varnames[method.co_argcount :]:
            place = short_place(method.co_filename, method.co_firstlineno)
            return f"{name} is a local variable of {method.co_name} ({place}): write self.{name} there"
    return ""


def misspelt_init(error: BaseException, frames: list[FrameType]) -> str:
    """Name the method meant as `__init__` where `Node.__init__` is called without a node name."""
    users = own(frames)
    if not users or not re.search(r"__init__\(\) missing \d+ required positional argument", str(error)):
        return ""
    for path in PATH.findall(line_of(frames)):
        cls = named(path, users[-1])
        if isinstance(cls, type) and "__init__" not in vars(cls):
            for name, method in vars(cls).items():
                if name.strip("_") in ("init", "int", "ini") and (code := getattr(method, "__code__", None)):
                    place = short_place(code.co_filename, code.co_firstlineno)
                    return f"{cls.__name__} has {name} ({place}): write __init__"
    return ""


def module_as_class(error: BaseException, frames: list[FrameType]) -> str:
    """Name the class to inherit from where a module stands for it: `class Talker(rclpy.node)`."""
    users = own(frames)
    line = line_of(frames)
    if not isinstance(error, TypeError) or not str(error).startswith("module() ") or not users:
        return ""
    for path in PATH.findall(line.partition("(")[2]):
        module = named(path, users[-1])
        if isinstance(module, ModuleType):
            last = module.__name__.rpartition(".")[2].replace("_", "")
            same = next((name for name in vars(module) if name.lower() == last and name != last), "")
            way = f": from {module.__name__} import {same}, and write {same} in place of {path}" if same else ""
            return f"{path} is a module, and no class{way}"
    return ""


def severity(error: BaseException, _frames: list[FrameType]) -> str:
    """Name the severity that a text stands for."""
    found = re.match(r"'(\w+)' is not a valid LoggingSeverity", str(error))
    if not isinstance(error, ValueError) or found is None:
        return ""
    names = list(sys.modules["rclpy.logging"].LoggingSeverity.__members__)
    near = nearest(found[1].upper(), names) or "INFO"
    return f"write LoggingSeverity.{near}, from rclpy.logging"


def _path_of(attribute: str, line: str) -> str:
    """Return the owner of an attribute that a line reads: `self.pub` of `self.pub.publish(m)`."""
    paths = [path.rpartition(".") for path in PATH.findall(line)]
    return next((owner for owner, _, name in paths if name == attribute and owner), "")


def _unbound(name: str, frame: FrameType) -> str:
    """Suggest the intended name for one that is not bound in a frame."""
    if frame.f_code.co_name == name and "__qualname__" in frame.f_locals:
        return f"this line is inside class {name}: indent it less"
    node = frame.f_locals.get("self")
    if node is not None and (name in vars(node) or hasattr(type(node), name)):
        return f"write self.{name}"
    if name == "rclpy":
        return "write import rclpy"
    if way := _in_rclpy(name, "rclpy"):
        return way
    line = imports(name) or MODULES.get(name, "")
    if not line and os.path.isdir(os.path.join(SITE, name)):
        line = f"import {name}"
    for package in ("tf2_ros", "message_filters", "tf_transformations") if not line else ():
        with suppress(ImportError):  # the last one needs another package
            thing = vars(import_module(package)).get(name)
            if isinstance(thing, (type, FunctionType)) and thing.__module__.startswith(package):
                line = f"from {package} import {name}"
    return f"write {line}" if line else ""


def unset(error: BaseException, frames: list[FrameType]) -> str:
    """Name the method that sets an attribute that is still None."""
    users = own(frames)
    if not isinstance(error, AttributeError) or not users:
        return ""
    frame = users[-1]
    if not str(error).startswith("'NoneType' object"):
        return _unset_yet(error, frame)
    for path in PATH.findall(line_of(frames)):
        first, *rest = path.split(".")
        node = frame.f_locals.get(first)
        if first != "self" or len(rest) < 2 or rest[1] != error.name or vars(node).get(rest[0], node) is not None:
            continue
        for code in _functions(type(node)):
            sets = any(s.opname == "STORE_ATTR" and s.argval == rest[0] for s in dis.get_instructions(code))
            if sets and code is not frame.f_code and code.co_name != "__init__":
                place = short_place(code.co_filename, code.co_firstlineno)
                name = f"self.{rest[0]}"
                return f"{name} is None until {code.co_name} ({place}) sets it: write if {name} is None: return"
    return ""


def without_value(error: BaseException, frames: list[FrameType]) -> str:
    """Name a parameter that was declared without a value where None, its value, fits no operation."""
    users = own(frames)
    if not isinstance(error, TypeError) or "NoneType" not in str(error) or not users:
        return ""
    parameters = users[-1].f_locals["self"].get_parameters_by_prefix("")
    for name in re.findall(r"\w+", line_of(frames)):
        if name in parameters and parameters[name].value is None:
            return f"the parameter {name!r} has no value: declare it with one, declare_parameter({name!r}, 1.0)"
    return ""


def _unset_yet(error: AttributeError, frame: FrameType) -> str:
    """Name the callback that sets an attribute which a node does not have yet."""
    node = frame.f_locals.get("self")
    if node is None or error.obj is not node:
        return ""
    for code in _functions(type(node)):
        sets = any(s.opname == "STORE_ATTR" and s.argval == error.name for s in dis.get_instructions(code))
        if sets and code is not frame.f_code and code.co_name != "__init__":
            place, name = short_place(code.co_filename, code.co_firstlineno), f"self.{error.name}"
            ways = f"write {name} = None in __init__, and here if {name} is None: return"
            return f"{name} is not there until {code.co_name} ({place}) sets it: {ways}"
    return ""


def _functions(cls: type) -> Iterator[CodeType]:
    """Return the code of a class's user-defined methods."""
    for owner in cls.__mro__:
        for value in vars(owner).values():
            code = getattr(value, "__code__", None)
            if isinstance(code, CodeType) and is_users(code.co_filename):
                yield code


FORMER = {
    "rclpy.init_node": "write rclpy.init(), and node = rclpy.create_node('name')",
    "rclpy.Publisher": "write node.create_publisher(Type, 'topic', 10)",
    "rclpy.Subscriber": "write node.create_subscription(Type, 'topic', callback, 10)",
    "rclpy.Rate": "make a timer in place of the loop: node.create_timer(0.1, callback)",
    "rclpy.sleep": "make a timer: node.create_timer(1.0, callback)",
    "rclpy.is_shutdown": "write not rclpy.ok()",
    "rclpy.loginfo": "write node.get_logger().info(...)",
    "rclpy.get_param": "write node.declare_parameter('name', 1.0).value",
}
"""Names from ROS 1's rospy."""


def _in_rclpy(name: str, asked: str) -> str:
    """Return the rclpy module that defines a name, or rclpy's name for a rospy one."""
    if f"{asked}.{name}" in FORMER:
        return FORMER[f"{asked}.{name}"]
    held = vars(sys.modules[asked]) if asked in sys.modules else {}
    there = [word for word in held if word.lower() == name.lower() and not isinstance(held[word], ModuleType)]
    if there:
        return f"did you mean {there[0]!r}?"
    enums = [cls for cls in held.values() if isinstance(cls, EnumType) and cls.__module__ == asked]
    enums = [cls for cls in enums if name in cls.__members__]
    if enums and asked != "rclpy":
        return f"{name} is a value of {enums[0].__name__}: import that, and write {enums[0].__name__}.{name}"
    modules = [f"rclpy.{found.name}" for found in pkgutil.iter_modules(sys.modules["rclpy"].__path__)]
    homes = {module: str(getattr(getattr(import_module(module), name, None), "__module__", "")) for module in modules}
    known = [module for module, home in homes.items() if home == module]
    known += [module for module, home in homes.items() if home.startswith(f"{module}.")]
    return f"{name} is in {known[0]}: from {known[0]} import {name}" if known else ""

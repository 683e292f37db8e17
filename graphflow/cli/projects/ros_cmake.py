"""Templates of a new ROS 2 package built by CMake: `CMakeLists.txt`, and a first program and library in C++."""

from __future__ import annotations

from collections.abc import Sequence

_HEAD = """\
cmake_minimum_required(VERSION 3.8)
project(@name)

if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()

"""
_NO_DEPENDENCY = "# One line for each package that this one needs: find_package(<dependency> REQUIRED)\n"
_INCLUDES = """\
target_include_directories(@target PUBLIC
  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
  $<INSTALL_INTERFACE:@include>)
"""
_FEATURES = "target_compile_features(@target PUBLIC c_std_99 cxx_std_17)\n"
_LIBRARY = f"""
add_library(@target@shared src/@target.cpp)
add_library(@name::@target ALIAS @target)
{_FEATURES}{_INCLUDES}@links\
# Only the library itself exports its symbols; see visibility_control.h.
target_compile_definitions(@target PRIVATE "@NAME_BUILDING_LIBRARY")

install(DIRECTORY include/ DESTINATION @include)
install(TARGETS @target EXPORT export_@name
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin)
"""
_PROGRAM = f"""
add_executable(@target src/@target.cpp)
{_INCLUDES}@links
install(TARGETS @target@export DESTINATION lib/${{PROJECT_NAME}})
"""
_TESTING = """
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # Two linters are left out: remove the first line once all files have copyright headers, and the second one, too, once
  # the package is in a git repository.
  set(ament_cmake_copyright_FOUND TRUE)
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""
_EXPORTS = """
ament_export_include_directories("include/${PROJECT_NAME}")
ament_export_libraries(@target)
ament_export_targets(export_@name)
"""
_MODULES = "\nament_python_install_package(${PROJECT_NAME})\n"
_VERSION = """\
set(@name_MAJOR_VERSION 0)
set(@name_MINOR_VERSION 0)
set(@name_PATCH_VERSION 0)
set(@name_VERSION ${@name_MAJOR_VERSION}.${@name_MINOR_VERSION}.${@name_PATCH_VERSION})

"""
_PACKAGE_FILES = """
export(EXPORT export_@name FILE "${PROJECT_BINARY_DIR}/export_@name.cmake")

# The files by which other projects find this one.
set(CONF_INCLUDE_DIRS "${CMAKE_INSTALL_PREFIX}/include")
configure_file(@nameConfig.cmake.in "${PROJECT_BINARY_DIR}/${CMAKE_FILES_DIRECTORY}/@nameConfig.cmake" @ONLY)
configure_file(@nameConfigVersion.cmake.in "${PROJECT_BINARY_DIR}/@nameConfigVersion.cmake" @ONLY)
install(FILES
  "${PROJECT_BINARY_DIR}/${CMAKE_FILES_DIRECTORY}/@nameConfig.cmake"
  "${PROJECT_BINARY_DIR}/@nameConfigVersion.cmake"
  DESTINATION "share/${PROJECT_NAME}/cmake" COMPONENT dev)
install(EXPORT export_@name
  DESTINATION "share/${PROJECT_NAME}/cmake" FILE export_@name.cmake COMPONENT dev)
"""


def _filled(text: str, **values: str) -> str:
    """Replace the placeholders `@NAME` in a text; the longest first, since one may be the beginning of another."""
    for word in sorted(values, key=len, reverse=True):
        text = text.replace(f"@{word}", values[word])
    return text


def ament(name: str, dependencies: Sequence[str], node: str | None, library: str | None) -> str:
    """Return the `CMakeLists.txt` of a package of the build type ament_cmake."""
    found = ["ament_cmake", *(["ament_cmake_ros"] if library else []), *dependencies]
    text = (
        _HEAD + "".join(f"find_package({one} REQUIRED)\n" for one in found) + ("" if dependencies else _NO_DEPENDENCY)
    )
    words = " ".join(f'"{one}"' for one in dependencies)
    needs = f"ament_target_dependencies(@target {words})\n" if words else ""
    include = "include/${PROJECT_NAME}"
    if library:
        text += _filled(_filled(_LIBRARY, links=needs, shared=""), target=library, include=include)
    if node:
        links = f"target_link_libraries(@target {library})\n" if library else _FEATURES + needs
        text += _filled(_filled(_PROGRAM, links=links, export=""), target=node, include=include)
    text += _TESTING + (_filled(_EXPORTS, target=library) if library else "") + "\nament_package()\n"
    return _filled(text, name=name, NAME=name.upper())


def with_modules(text: str) -> str:
    """Extend a `CMakeLists.txt` for a package that has Python modules, too."""
    for line, more in (
        ("find_package(ament_cmake REQUIRED)\n", "find_package(ament_cmake_python REQUIRED)\n"),
        ("  find_package(ament_lint_auto REQUIRED)\n", "  find_package(ament_cmake_pytest REQUIRED)\n"),
    ):
        text = text.replace(line, line + more)
    return text.replace("\nif(BUILD_TESTING)", f"{_MODULES}\nif(BUILD_TESTING)")


def plain(name: str, dependencies: Sequence[str], node: str | None, library: str | None) -> str:
    """Return the `CMakeLists.txt` of a package of the build type cmake, which does not use ament."""
    text = _HEAD.replace("\n\nif(", f"\n\n{_VERSION}if(", 1)
    text += "".join(f"find_package({one} REQUIRED)\n" for one in dependencies) or _NO_DEPENDENCY
    folders = " ".join(f"${{{one}_INCLUDE_DIRS}}" for one in dependencies)
    libraries = " ".join(f"${{{one}_LIBRARIES}}" for one in dependencies)
    needs = (
        f"target_include_directories(@target PUBLIC {folders})\ntarget_link_libraries(@target {libraries})\n"
        if dependencies
        else ""
    )
    if library:
        text += _filled(_filled(_LIBRARY, links=needs, shared=" SHARED"), target=library, include="include")
    if node:
        links = f"target_link_libraries(@target {library})\n" if library else _FEATURES + needs
        text += _filled(_filled(_PROGRAM, links=links, export=" EXPORT export_@name"), target=node, include="include")
    if node or library:
        text += _PACKAGE_FILES
    return _filled(text, name=name, NAME=name.upper())


def config(name: str, node: str | None, library: str | None) -> str:
    """Return the file by which CMake finds a package of the build type cmake."""
    text = 'set(@name_INCLUDE_DIRS "@CONF_INCLUDE_DIRS@")\ninclude("${@name_DIR}/export_@name.cmake")\n'
    text += f"set(@name_LIBRARIES {library})\n" if library else ""
    text += f"set(@name_EXECUTABLE {node})\n" if node else ""
    return _filled(text, name=name)


def config_version(name: str) -> str:
    """Return the file by which CMake checks the version of such a package."""
    return f"""\
set(PACKAGE_VERSION "@{name}_VERSION@")

if(PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_VERSION VERSION_EQUAL PACKAGE_FIND_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
"""


def program(name: str) -> str:
    """Return a first program in C++."""
    return f"""\
#include <cstdio>

int main()
{{
  std::printf("hello world {name} package\\n");
  return 0;
}}
"""


def _class_name(library: str) -> str:
    return library.replace("_", " ").title().replace(" ", "")


def header(name: str, library: str) -> str:
    """Return the header of a first library in C++."""
    guard = f"{name.upper()}__{library.upper()}_HPP_"
    made = _class_name(library)
    return f"""\
#ifndef {guard}
#define {guard}

#include "{name}/visibility_control.h"

namespace {name}
{{

class {name.upper()}_PUBLIC {made}
{{
public:
  {made}();
  virtual ~{made}();
}};

}}  // namespace {name}

#endif  // {guard}
"""


def library(name: str, library: str) -> str:
    """Return the source of a first library in C++."""
    made = _class_name(library)
    return f"""\
#include "{name}/{library}.hpp"

namespace {name}
{{

{made}::{made}() = default;

{made}::~{made}() = default;

}}  // namespace {name}
"""


def visibility(name: str) -> str:
    """Return the header with the visibility macros of a library."""
    guard = f"{name.upper()}__VISIBILITY_CONTROL_H_"
    return _filled(_VISIBILITY, guard=guard, NAME=name.upper())


_VISIBILITY = """\
#ifndef @guard
#define @guard

#if defined(_WIN32) || defined(__CYGWIN__)
#define @NAME_EXPORT __declspec(dllexport)
#define @NAME_IMPORT __declspec(dllimport)
#define @NAME_LOCAL
#ifdef @NAME_BUILDING_LIBRARY
#define @NAME_PUBLIC @NAME_EXPORT
#else
#define @NAME_PUBLIC @NAME_IMPORT
#endif
#else
#define @NAME_EXPORT __attribute__((visibility("default")))
#define @NAME_IMPORT
#define @NAME_LOCAL __attribute__((visibility("hidden")))
#define @NAME_PUBLIC @NAME_EXPORT
#endif
#define @NAME_PUBLIC_TYPE @NAME_PUBLIC

#endif  // @guard
"""

#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What stands around the installed files: SystemC by a CMake package of its own, and Debian packages of this build.

usage: builds_test.py CMAKE BUILD SOURCE CXX [unittest options]"""
import os
import pathlib
import re
import shutil
import sys
import unittest

sys.dont_write_bytecode = True
from installed_test import BUILD, CMAKE, CXX, GOLDEN_MAIN, Scratch, call, one_file, pkg_config  # noqa: E402


PACKAGE = """set(SystemC_CXX_STANDARD 17)
if(NOT TARGET SystemC::systemc AND NOT "{library}" STREQUAL "")
  add_library(SystemC::systemc UNKNOWN IMPORTED)
  set_target_properties(SystemC::systemc PROPERTIES IMPORTED_LOCATION "{library}"
    INTERFACE_INCLUDE_DIRECTORIES "{include}" INTERFACE_COMPILE_FEATURES cxx_std_17)
endif()
"""
VERSION = """set(PACKAGE_VERSION "{version}")
set(PACKAGE_VERSION_COMPATIBLE TRUE)
"""
ASKS = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 23)
list(PREPEND CMAKE_MODULE_PATH "{modules}")
find_package(SystemC {how})
message("standard of the project: ${{CMAKE_CXX_STANDARD}}")
if(SystemC_FOUND)
  find_package(SystemC REQUIRED)
  get_target_property(definitions SystemC::systemc INTERFACE_COMPILE_DEFINITIONS)
  message("SystemC ${{SystemC_VERSION}}, ${{definitions}}")
  set(CMAKE_CXX_STANDARD 20)
  add_executable(user main.cpp)
  target_link_libraries(user PRIVATE SystemC::systemc)
endif()
"""
MAIN = """#include <systemc>
int sc_main(int, char**) { return sc_core::sc_delta_count() != 0; }
"""
DEBIAN = "-DCMAKE_DISABLE_FIND_PACKAGE_SystemCLanguage=ON"


class SystemC(Scratch):
    """FindSystemC.cmake, as installed, on made-up packages as SystemC 3.0 has one, around the library of this machine."""

    def setUp(self):
        super().setUp()
        self.write("main.cpp", MAIN)
        self.asks("REQUIRED")
        self.configure(DEBIAN)
        cache = (self.folder / "build/CMakeCache.txt").read_text(encoding="utf-8")
        self.library, self.include = (re.search(rf"^SystemC_{what}:\w+=(.*)$", cache, re.M)[1]
                                      for what in ("LIBRARY", "INCLUDE_DIR"))

    def asks(self, how):
        self.write("CMakeLists.txt", ASKS.format(modules=one_file("lib*/**/FindSystemC.cmake").parent, how=how))

    def package(self, library, version="3.0.1"):
        folder = "systemc/lib/cmake/SystemCLanguage"
        self.write(f"{folder}/SystemCLanguageConfig.cmake", PACKAGE.format(library=library, include=self.include))
        self.write(f"{folder}/SystemCLanguageConfigVersion.cmake", VERSION.format(version=version))
        return [f"-DSystemCLanguage_DIR={self.folder / folder}", DEBIAN.replace("ON", "OFF")]

    def test_what_cannot_be_used_is_said(self):
        stub = self.folder / "libsystemc.a"
        call("ar", "rcs", stub)
        for options, words in (
                (self.package(""), "defines no target SystemC::systemc: install SystemC again, or configure with"),
                (self.package(self.library, "2.3.1"), "SystemC 2.3.1 at"),
                (self.package(self.library, "2.3.1"), "is too old. Install Debian's package libsystemc-dev"),
                (self.package(stub), "a C++20 program links with it under no baseline"),
                ([DEBIAN, "-DSystemC_LIBRARY=", "-DSystemC_INCLUDE_DIR="], "SystemC was not found. Install Debian's package")):
            # The folder holds the last of them.
            if not options[0].endswith("=ON"):
                library = {"defines": "", "a C++20": stub}.get(words[:7], self.library)
                self.package(library, "2.3.1" if "2.3.1" in words or "old" in words else "3.0.1")
            for how, code in (("REQUIRED", 1), ("QUIET", 0)):
                shutil.rmtree(self.folder / "build", ignore_errors=True)
                self.asks(how)
                said = self.configure(*options, code=code)
                self.assertIn("standard of the project: 23" if code == 0 else words, said)


class Debian(Scratch):
    """`cpack -G DEB`, of this build."""

    @classmethod
    def setUpClass(cls):
        if not shutil.which("dpkg-shlibdeps"):
            raise unittest.SkipTest("dpkg-dev is not installed")
        folder = BUILD / "examples/packages"
        shutil.rmtree(folder, ignore_errors=True)
        call(pathlib.Path(CMAKE).with_name("cpack"), "--config", BUILD / "CPackConfig.cmake", "-B", folder, "-G", "DEB",
             cwd=BUILD, env=dict(os.environ))
        cls.packages = {re.match(r"[a-z0-9-]+", file.name)[0]: file for file in folder.glob("*.deb")}

    def test_they_stand_alone(self):
        self.assertLessEqual({"deburr", "libdeburr-dev"}, set(self.packages))
        version = pkg_config("--modversion", "deburr-golden")[0]
        for name, depends in (("deburr", ("libsystemc", "libc6")), ("libdeburr-dev", ("libsystemc-dev", "libfmt-dev"))):
            fields = call("dpkg-deb", "--field", self.packages[name])
            self.assertRegex(fields, rf"(?m)^Version: {re.escape(version)}$")
            for package in depends:
                self.assertRegex(fields, rf"(?m)^Depends: .*\b{package}")
            call("dpkg-deb", "--extract", self.packages[name], self.folder / "root")
        self.assertIn(version, call(self.folder / "root/usr/bin/deburr", "--version"))
        self.project("deburr REQUIRED", "deburr::golden", GOLDEN_MAIN)
        call(CMAKE, "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={self.folder / 'root/usr'}",
             f"-DCMAKE_CXX_COMPILER={CXX}")
        call(CMAKE, "--build", self.folder / "build")
        call(self.folder / "build/user")


if __name__ == "__main__":
    unittest.main()

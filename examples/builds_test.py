#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Builds other than the one that installed_test.py installs: libraries from the other compiler, shared libraries,
SystemC with its own CMake package, Debian packages. Builds stay in BUILD/examples, so the next run compiles only
changes.

usage: builds_test.py CMAKE BUILD SOURCE CXX [unittest options]"""
import os
import pathlib
import re
import shutil
import sys
import unittest

sys.dont_write_bytecode = True
from installed_test import (BUILD, CMAKE, CXX, DECLARED, EMPTY, EXAMPLES, GOLDEN_MAIN, INCLUDE, MODELS_MAIN, PREFIX,  # noqa: E402
                            PYTHON_BUILT, SOURCE, Scratch, block_of, call, exported, main, one_file, pkg_config)

OTHER = "g++" if "clang" in CXX else "clang++"


def built(name, *options):
    """Installs the preset `libraries` with these options and returns the prefix."""
    build, prefix = BUILD / "examples" / name, BUILD / "examples" / f"{name}-prefix"
    env = dict(os.environ)
    call(CMAKE, "--preset", "libraries", "-B", build, "-DDEBURR_WERROR=ON", *options, cwd=SOURCE, env=env)
    call(CMAKE, "--build", build, "--parallel", os.cpu_count(), env=env, timeout=1500)
    shutil.rmtree(prefix, ignore_errors=True)
    call(CMAKE, "--install", build, "--prefix", prefix, env=env)
    return prefix


@unittest.skipUnless(shutil.which(OTHER), f"{OTHER} is not installed: scripts/install examples")
class Compiler(Scratch):
    """A release build by the compiler that did not build this tree."""

    def test_platform_draws_the_same_picture(self):
        prefix = built("other-compiler", f"-DCMAKE_CXX_COMPILER={OTHER}")
        for library in prefix.glob("lib*/**/libdeburr-*.a"):
            made_by = call("readelf", "-p", ".comment", library)
            self.assertEqual("clang version" in made_by, "clang" in OTHER, library)
            self.assertEqual("GCC: " in made_by, "clang" not in OTHER, library)
        shutil.copytree(EXAMPLES / "platform", self.folder, dirs_exist_ok=True)
        said = []
        for compiler, where, options in ((CXX, PREFIX, ["-DCMAKE_BUILD_TYPE=Debug"]), (OTHER, prefix, [])):
            build = self.folder / pathlib.Path(compiler).name
            call(CMAKE, "-S", self.folder, "-B", build, f"-DCMAKE_PREFIX_PATH={where}", f"-DCMAKE_CXX_COMPILER={compiler}",
                 *options)
            call(CMAKE, "--build", build, "--parallel", os.cpu_count())
            said.append(call(build / "platform"))
        self.assertIn("PASS picture", said[0])
        self.assertEqual(*said)


class Shared(Scratch):
    """Shared libraries, compiled with little optimisation."""

    @classmethod
    def setUpClass(cls):
        cls.prefix = built("shared", "-DBUILD_SHARED_LIBS=ON", "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_CXX_COMPILER={CXX}")
        cls.libraries = next(cls.prefix.glob("lib*/**/libdeburr-golden.so")).parent
        cls.env = EMPTY | {"PKG_CONFIG_PATH": str(cls.libraries / "pkgconfig"), "LD_LIBRARY_PATH": str(cls.libraries)}

    def flags(self, name):
        return call("pkg-config", "--cflags", "--libs", name, env=self.env).split()

    def test_programs_link_shared_libraries(self):
        self.project("deburr REQUIRED", "deburr::golden deburr::models", MODELS_MAIN)
        call(CMAKE, "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             f"-DCMAKE_CXX_COMPILER={CXX}")
        call(CMAKE, "--build", self.folder / "build")
        call(self.folder / "build/user")
        number = pkg_config("--modversion", "deburr-golden")[0].rsplit(".", 1)[0]
        for name, main in (("golden", GOLDEN_MAIN), ("models", MODELS_MAIN)):
            call(CXX, self.write(f"{name}.cpp", main), "-o", self.folder / name, *self.flags(f"deburr-{name}"))
            call(self.folder / name, env=self.env)
            self.assertIn(f"[libdeburr-{name}.so.{number}]", call("readelf", "-d", self.folder / name))

    def test_c_library_exports_only_its_interface(self):
        library = self.libraries / "libdeburr-golden-c.so"
        declared = set(DECLARED.findall((INCLUDE / "deburr_golden.h").read_text(encoding="utf-8")))
        self.assertGreater(len(declared), 30)
        self.assertEqual(exported("nm", "-D", "--defined-only", library), declared)
        self.assertIn("[libdeburr-golden-c.so.0]", call("readelf", "-d", library))
        call("cc", "-std=c99", EXAMPLES / "c/draw.c", "-o", self.folder / "draw", *self.flags("deburr-golden-c"))
        self.assertIn("PASS picture", call(self.folder / "draw", "picture.ppm", cwd=self.folder, env=self.env))

    @unittest.skipUnless(shutil.which("verilator"), "verilator is not installed: scripts/install examples")
    def test_simulators_load_the_object_of_the_page(self):
        installs, commands = block_of("howto/testbench", "-shared").split("\n", 1)
        self.assertRegex(installs, r"^cmake --preset libraries -DBUILD_SHARED_LIBS=ON && .* --prefix ~/deburr$")
        header = next(pathlib.Path(call("verilator", "--getenv", "VERILATOR_ROOT").strip()).rglob("svdpi.h"))
        (self.folder / "simulator").mkdir()
        (self.folder / "simulator/include").symlink_to(header.parent)
        said = self.as_on_the_page(f"SIMULATOR=simulator\n{commands}\nldd deburr_golden_dpi.so")
        self.assertIn(f"libdeburr-golden-c.so.0 => {self.folder}/home/deburr/lib/", said)
        self.assertNotIn("not found", said)


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


@unittest.skipUnless(pathlib.Path("/usr/include/systemc").exists(),
                     "Debian's SystemC is not installed: scripts/install libraries")
class SystemC(Scratch):
    """The installed FindSystemC.cmake with fake packages in the form of SystemC 3.0, around this machine's library."""

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

    def test_cxx_standard_is_probed_and_program_links(self):
        # In the build folder that has probed Debian's package before.
        for fresh in (False, True):
            if fresh:
                shutil.rmtree(self.folder / "build")
            said = self.configure(*self.package(self.library))
            self.assertIn("SystemC 3.0.1, ", said)
            self.assertIn("standard of the project: 23", said)
            self.assertLessEqual(said.count("SC_CPLUSPLUS="), 1)
            call(CMAKE, "--build", self.folder / "build")
            call(self.folder / "build/user")
        back = self.configure(DEBIAN)
        self.assertNotIn("SystemC 3.0.1", back)
        call(CMAKE, "--build", self.folder / "build")
        call(self.folder / "build/user")

    def test_no_other_systemc_than_that_of_root_is_accepted(self):
        self.package(self.library)
        root = f"-DSystemC_ROOT={self.folder / 'systemc'}"
        self.assertIn("SystemC 3.0.1, ", self.configure(root, DEBIAN.replace("ON", "OFF")))
        self.assertNotIn("SystemC 3.0.1", self.configure("-USystemC_ROOT", DEBIAN))
        for fresh in (False, True):  # the cache holds Debian's
            if fresh:
                shutil.rmtree(self.folder / "build")
            said = " ".join(self.configure(root, DEBIAN, code=1).split())
            self.assertIn(f"There is no SystemC in {self.folder / 'systemc'} (SystemC_ROOT or SYSTEMC_HOME)", said)

    def test_libraries_configure_with_systemc_3_package(self):
        build = self.folder / "libraries"
        call(CMAKE, "--preset", "libraries", "-B", build, *self.package(self.library), cwd=SOURCE)
        self.assertIn('set(_deburr_systemc "3.0.1")', (build / "installed/cmake/deburr-config.cmake").read_text(encoding="utf-8"))
        # A systemc.pc is not required.
        models = (build / "installed/deburr-models.pc").read_text(encoding="utf-8")
        self.assertRegex(models, rf"(?m)^Libs: .* {re.escape(self.library)} ")
        self.assertNotRegex(models, r"(?m)^Requires: .*systemc")

    def test_unusable_package_is_reported(self):
        stub = self.folder / "libsystemc.a"
        call("ar", "rcs", stub)
        for options, words in (
                (self.package(""), "defines no target SystemC::systemc: install SystemC again, or configure with"),
                (self.package(self.library, "2.3.1"), "SystemC 2.3.1 at"),
                (self.package(self.library, "2.3.1"), "is too old. Install Debian's package libsystemc-dev"),
                (self.package(stub), "a C++20 program links with it under no baseline"),
                ([DEBIAN, "-DSystemC_LIBRARY=", "-DSystemC_INCLUDE_DIR="], "SystemC was not found. Install Debian's package")):
            # The folder still holds the last of them.
            if not options[0].endswith("=ON"):
                library = {"defines": "", "a C++20": stub}.get(words[:7], self.library)
                self.package(library, "2.3.1" if "2.3.1" in words or "old" in words else "3.0.1")
            for how, code in (("REQUIRED", 1), ("QUIET", 0)):
                shutil.rmtree(self.folder / "build", ignore_errors=True)
                self.asks(how)
                said = self.configure(*options, code=code)
                self.assertIn("standard of the project: 23" if code == 0 else words, said)
                self.assertNotRegex(said, r"SystemC [\d.]*, ")  # message when it was found

    def test_systemc_other_than_the_build_is_reported(self):
        self.project("deburr REQUIRED COMPONENTS models")
        said = self.configure(*self.package(self.library, "3.9.9"), code=1)
        self.assertRegex(said, r"built with SystemC \S+, and SystemC 3\.9\.9 was found: install that version, or build Deburr")

    def test_missing_systemc_names_the_package_to_install(self):
        said = " ".join(call(CMAKE, "--preset", "libraries", "-B", self.folder / "libraries", DEBIAN, "-DSystemC_LIBRARY=",
                             "-DSystemC_INCLUDE_DIR=", cwd=SOURCE, code=1).split())
        for words in ("`scripts/install libraries` installs Debian's package libsystemc-dev", "SYSTEMC_HOME",
                      "a CMake package of SystemC 3.0"):
            self.assertIn(words, said)


class Debian(Scratch):
    """`cpack -G DEB` for this build, with or without the Python module. The preset `package` is only configured,
    since it would compile everything again."""

    @classmethod
    def setUpClass(cls):
        if not shutil.which("dpkg-shlibdeps"):
            raise unittest.SkipTest("dpkg-dev is not installed")
        folder = BUILD / "examples/packages"
        shutil.rmtree(folder, ignore_errors=True)
        call(pathlib.Path(CMAKE).with_name("cpack"), "--config", BUILD / "CPackConfig.cmake", "-B", folder, "-G", "DEB",
             cwd=BUILD, env=dict(os.environ))
        cls.packages = {re.match(r"[a-z0-9-]+", file.name)[0]: file for file in folder.glob("*.deb")}

    def extract(self, depends):
        """Unpacks the packages into a separate root and checks version and dependencies of each."""
        version = pkg_config("--modversion", "deburr-golden")[0]
        for name, others in depends.items():
            fields = call("dpkg-deb", "--field", self.packages[name])
            self.assertRegex(fields, rf"(?m)^Version: {re.escape(version)}-1$")
            for package in others:
                self.assertRegex(fields, rf"(?m)^Depends: (.*, )?{re.escape(package)}( |,|$)")
            call("dpkg-deb", "--extract", self.packages[name], self.folder / "root")
        return version

    def test_every_built_component_has_a_package(self):
        self.assertEqual(set(self.packages), {"deburr", "libdeburr-dev"} | ({"python3-deburr"} if PYTHON_BUILT else set()))

    def test_documented_preset_makes_the_same_packages(self):
        line = block_of("howto/use_in_my_platform", "cpack").splitlines()[0]
        self.assertEqual(line, "cmake --preset package && cmake --build --preset package && cpack --preset package")
        build, env = self.folder / "build", dict(os.environ)
        for tool in ([CMAKE, "--build"], [pathlib.Path(CMAKE).with_name("cpack")]):
            self.assertRegex(call(*tool, "--list-presets", cwd=SOURCE, env=env), r'(?m)^ *"package"')
        call(CMAKE, "--preset", "package", "-B", build, cwd=SOURCE, env=env)
        cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
        self.assertRegex(cache, r"(?m)^CMAKE_INSTALL_PREFIX:\w+=/usr$")
        self.assertRegex(cache, r"(?m)^CMAKE_INSTALL_LIBDIR:\w+=lib/\w+-linux-gnu")
        self.assertIn(f"-ffile-prefix-map={SOURCE}/=./", cache)
        layers = re.findall(r"-ffile-prefix-map=\S*/build/package/layers/(\w+)/= ?", cache)
        self.assertLessEqual(set(layers), {folder.name for folder in (build / "layers").iterdir()})
        packing = (build / "CPackConfig.cmake").read_text(encoding="utf-8")
        components = {"program", "development"} | ({"python"} if PYTHON_BUILT else set())
        self.assertEqual(set(re.search(r'CPACK_COMPONENTS_ALL "(.*)"', packing)[1].split(";")), components)
        self.assertIn(f'CPACK_PACKAGE_DIRECTORY "{build}/packages"', packing)

    def test_packages_are_self_contained(self):
        version = self.extract({"deburr": ("libsystemc", "libc6"), "libdeburr-dev": ("libsystemc-dev", "libfmt-dev")})
        self.assertIn(version, call(self.folder / "root/usr/bin/deburr", "--version"))
        self.project("deburr REQUIRED", "deburr::golden", GOLDEN_MAIN)
        call(CMAKE, "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={self.folder / 'root/usr'}",
             f"-DCMAKE_CXX_COMPILER={CXX}")
        call(CMAKE, "--build", self.folder / "build")
        call(self.folder / "build/user")

    @unittest.skipUnless(PYTHON_BUILT, "the Python module was not built: scripts/install python")
    def test_python_module_finds_the_command_of_its_package(self):
        version = pkg_config("--modversion", "deburr-golden")[0]
        self.extract({"deburr": (), "python3-deburr": (f"deburr (= {version}-1)", "python3-numpy")})
        root = self.folder / "root/usr"
        said = call("/usr/bin/python3", "-c", """import deburr, numpy
smooth = deburr.ideal.fxaa(numpy.zeros((8, 8, 4), dtype=numpy.uint8))
run = deburr.run(deburr.engines()[0], scene="plane", size=(32, 32))
print(deburr.__file__, deburr.__version__, smooth.shape, run.cycles > 1024, deburr._program.program())
""", cwd=self.folder, env=EMPTY | {"PYTHONPATH": str(root / "lib/python3/dist-packages"), "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(said.split(), [f"{root}/lib/python3/dist-packages/deburr/__init__.py", version, "(8,", "8,", "4)", "True",
                                        f"{root}/libexec/deburr/deburr"])

    @unittest.skipUnless(shutil.which("lintian"), "lintian is not installed: scripts/install examples")
    def test_lintian_accepts_them(self):
        # In the preset `package` libraries are in Debian's location, since its prefix is /usr.
        said = call("lintian", "--tag-display-limit", "0", "--fail-on", "error", "--suppress-tags",
                    "pkg-config-unavailable-for-cross-compilation", *self.packages.values(), env=dict(os.environ))
        self.assertNotRegex(said, r"(?m)^[EW]: ")


if __name__ == "__main__":
    main()

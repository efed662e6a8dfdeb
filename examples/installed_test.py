#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What `cmake --install` installs, and the examples, built from the installed files in an environment that sees
nothing else of the repository. Class Install writes BUILD/examples/prefix, which the other classes use.

usage: installed_test.py CMAKE BUILD SOURCE CXX [unittest options]"""
import concurrent.futures
import functools
import gzip
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

CMAKE, BUILD, SOURCE, CXX = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1)), sys.argv.pop(1)
PREFIX = BUILD / "examples/prefix"
INCLUDE = PREFIX / "include/deburr"
EXAMPLES = PREFIX / "share/deburr/examples"
PYTHON = PREFIX / "lib/python3/dist-packages"
# Only paths: the tests check whether a file is installed.
PYTHON_BUILT = any((BUILD / "python").rglob("_golden*.so"))
# The minimum that a user's shell has; nothing of Deburr.
EMPTY = {"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", "LC_ALL": "C.UTF-8"}

INCLUDED = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)
OURS = ("spec/", "golden/", "rtl_model/")
SYSTEMC = ("systemc", "tlm", "tlm_utils/")
OTHERS = ("fmt/",)
STANDARD_C = ("stddef.h", "stdint.h")
DECLARED = re.compile(r"^[a-z].*?\b(deburr_\w+)\(", re.M)


def call(*command, code=0, cwd=None, env=None, timeout=600):
    """Standard output of a command."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, env=env or EMPTY, text=True, timeout=timeout,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    wanted = (code,) if isinstance(code, int) else code
    if done.returncode not in wanted:
        raise AssertionError(f"{command}\nexit code {done.returncode}, expected {wanted}\n{done.stdout}")
    return done.stdout


def beside(prefix):
    """Folders of the source and of the build that do not lead to a prefix, including other builds and prefixes."""
    ways = {SOURCE, BUILD} | {folder for folder in prefix.parents if {SOURCE, BUILD} & set(folder.parents)}
    return [folder for way in sorted(ways) for folder in sorted(way.iterdir())
            if folder.is_dir() and not folder.is_symlink() and not prefix.is_relative_to(folder)]


@functools.lru_cache
def hiding(prefix=PREFIX):
    """The command prefix that hides the source and the build except for one prefix; None where this user may not
    mount. Files next to the path to the prefix stay visible: no installed file holds a path to them (Files)."""
    folders = beside(prefix)
    script = ('for folder in "${@:1:$FOLDERS}"; do [ ! -d "$folder" ] || mount -t tmpfs none "$folder" || exit 99; done; '
              'exec "${@:FOLDERS+1}"')
    for unshare in (["unshare", "--mount"], ["unshare", "--mount", "--map-root-user"]):
        command = [*unshare, "env", f"FOLDERS={len(folders)}", "bash", "-c", script, "bash", *map(str, folders)]
        done = subprocess.run([*command, "ls", SOURCE / "spec", BUILD / "CMakeFiles"], text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode == 0 and not re.search(r"^(?!/)\S", done.stdout, re.M):
            return command
    return None


def alone(*command, prefix=PREFIX, **how):
    """Output of a command that sees only the prefix, where this user may hide the rest."""
    return call(*(hiding(prefix) or []), *command, **how)


def one_file(pattern):
    found = list(PREFIX.glob(pattern))
    if len(found) != 1:
        raise AssertionError(f"{pattern}: {len(found)} files")
    return found[0]


def pkg_config(*arguments, code=0):
    folder = one_file("lib*/**/pkgconfig/deburr-golden.pc").parent
    return call("pkg-config", *arguments, code=code, env=EMPTY | {"PKG_CONFIG_PATH": str(folder)}).split()


def blocks_of(page):
    """Contents of the blocks without a language on an installed page, one text each."""
    text = (PREFIX / f"share/deburr/docs/{page}.md").read_text(encoding="utf-8")
    return [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```", text, re.M | re.S) if not language]


def block_of(page, word):
    """The only block that contains this word."""
    found = [block for block in blocks_of(page) if word in block]
    if len(found) != 1:
        raise AssertionError(f"{page}: {len(found)} blocks with {word}")
    return found[0]


def not_printed(block, said):
    """Lines of a page that a program did not print; ... matches any text."""
    lines = [" ".join(line.split()) for line in said.splitlines()]
    wanted = [" ".join(line.split()) for line in block.splitlines()]
    return [line for line in wanted
            if not any(re.fullmatch(".*".join(map(re.escape, line.split("..."))), one) for one in lines)]


class Scratch(unittest.TestCase):
    prefix = PREFIX  # of the installation

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="deburr_installed_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def as_on_the_page(self, commands, code=0):
        """Output of a page's commands with only an installation in ~/deburr."""
        home = self.folder / "home"
        home.mkdir(exist_ok=True)
        if not (home / "deburr").exists():
            (home / "deburr").symlink_to(self.prefix)
        return alone("bash", "-c", commands, prefix=self.prefix, cwd=self.folder, code=code, timeout=1500, env=EMPTY | {
            "HOME": str(home), "CXX": CXX, "CMAKE_BUILD_PARALLEL_LEVEL": str(os.cpu_count()), "CCACHE_DISABLE": "1",
            "PYTHONDONTWRITEBYTECODE": "1"})

    def after_installing(self, page):
        """Output of the first block of a page that begins with the installation, and the page's next block."""
        first, shown = blocks_of(page)[:2]
        installs, commands = first.split("\n", 1)
        self.assertRegex(installs, r"^cmake --preset libraries && .* --prefix ~/deburr$")
        return self.as_on_the_page(commands), shown

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    def project(self, find, link="", main="int main() {}", version="3.25", more=""):
        """A user's project."""
        self.write("main.cpp", main)
        self.write("CMakeLists.txt", f"cmake_minimum_required(VERSION {version})\nproject(user LANGUAGES CXX)\n"
                   f"find_package({find})\nadd_executable(user main.cpp)\ntarget_link_libraries(user PRIVATE {link})\n{more}\n")

    def configure(self, *options, code=0):
        return " ".join(alone(CMAKE, "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={PREFIX}",
                             f"-DCMAKE_CXX_COMPILER={CXX}", *options, code=code).split())


class Install(unittest.TestCase):
    def test_installs_and_can_be_moved(self):
        place = BUILD / "installed_here"
        for folder in (place, PREFIX):
            shutil.rmtree(folder, ignore_errors=True)
        call(CMAKE, "--install", BUILD, "--prefix", place / "first", env=dict(os.environ))
        (place / "first").rename(PREFIX)


class Files(Scratch):
    """Which files are installed, and that they do not refer to the trees."""

    def test_every_file_is_installed(self):
        for pattern in ("bin/deburr", "libexec/deburr/deburr", "libexec/deburr/deburr_papers", "libexec/deburr/deburr_train",
                        "libexec/deburr/libdeburr_images.so", "libexec/deburr/libdeburr_evolution.so",
                        "lib*/**/libdeburr-golden.*[ao]", "lib*/**/libdeburr-models.*[ao]",
                        "include/deburr/deburr_registers.h", "include/deburr/deburr_golden.h",
                        "share/deburr/systemverilog/deburr_golden_pkg.sv",
                        "share/deburr/systemverilog/deburr_golden_dpi.c", "share/man/man1/deburr.1.gz",
                        "share/bash-completion/completions/deburr", "share/zsh/vendor-completions/_deburr",
                        "share/fish/vendor_completions.d/deburr.fish", "share/deburr/sweeps/texture_cache.yaml",
                        "share/deburr/tb/testplan/smoke.yaml", "share/deburr/docs/howto/use_in_my_platform.md",
                        "share/doc/deburr/copyright", "share/doc/libdeburr-dev/changelog.gz"):
            one_file(pattern)
        headers = {file.relative_to(SOURCE) for layer in OURS for file in (SOURCE / layer).rglob("*.h")}
        # Only the header of the C interface is installed.
        headers = {file for file in headers if file.parts[:2] != ("golden", "c")}
        installed = {file.relative_to(INCLUDE) for file in INCLUDE.rglob("*.h")}
        folders = ("c", "dramsys", "platform", "systemverilog", *(["python"] if PYTHON_BUILT else []))
        examples = {file.relative_to(SOURCE / "examples") for folder in folders
                    for file in (SOURCE / "examples" / folder).rglob("*")}
        examples = {file for file in examples if "build" not in file.parts}  # left by a reader who has tried it in the source
        self.assertGreater(len(examples), 20)
        self.assertEqual(examples, {file.relative_to(EXAMPLES) for file in EXAMPLES.rglob("*")} - {pathlib.Path(f) for f in folders})
        self.assertEqual(headers | {pathlib.Path("deburr_registers.h"), pathlib.Path("deburr_golden.h")}, installed)

    def test_no_file_names_the_trees(self):
        names = [str(path).encode() for path in (SOURCE, BUILD)]

        def naming(folder):
            found = []
            for file in folder.rglob("*"):
                content = file.read_bytes() if file.is_file() and not file.is_symlink() else b""
                if content[:4] == b"\x7fELF":  # messages of checks may contain source paths
                    content = call("readelf", "-d", file).encode()
                elif content[:7] == b"!<arch>":
                    continue
                if any(name in content for name in names) or file.is_symlink() and os.path.isabs(os.readlink(file)):
                    found.append(file.name)
            return found

        self.assertEqual(naming(PREFIX), [])
        self.write("injected.cmake", f'include("{BUILD}/x.cmake")')
        (self.folder / "injected").symlink_to(SOURCE)
        self.assertEqual(sorted(naming(self.folder)), ["injected", "injected.cmake"])


def foreign_includes(root):
    """file: include of a header that other projects would have to install."""
    found = []
    for file in sorted(root.rglob("*.h")):
        for header in INCLUDED.findall(file.read_text(encoding="utf-8")):
            standard = "/" not in header and not header.endswith((".h", ".hpp"))
            known = (header.startswith((*OURS, *OTHERS)) or header.startswith("tlm_utils/")
                     or header in (*SYSTEMC, *STANDARD_C))
            if not known and not standard:
                found.append(f"{file.relative_to(root)}: {header}")
            if not file.is_relative_to(root / "rtl_model") and (header in SYSTEMC or header.startswith("tlm_utils/")):
                found.append(f"{file.relative_to(root)}: {header}")
    return found


def compiles(header, flags):
    """Compiler output for a program that includes only this header, twice."""
    text = f'#include "{header}"\n#include "{header}"\n'
    done = subprocess.run([CXX, "-fsyntax-only", "-x", "c++", "-Wall", "-Wextra", "-Werror", *flags, "-"], input=text,
                          env=EMPTY, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.stdout if done.returncode else ""


class Alone(Scratch):
    """The tests of the examples see only the prefix."""

    def test_trees_are_hidden_and_the_prefix_is_visible(self):
        if not hiding():
            self.skipTest("this user may not mount")
        self.assertEqual(alone("find", SOURCE / "spec", "-name", "*.h"), "")
        # Neither another build of this tree nor a prefix from another test is visible.
        with tempfile.TemporaryDirectory(dir=BUILD.parent) as build, tempfile.TemporaryDirectory(dir=PREFIX.parent) as prefix:
            for folder in (build, prefix):
                (pathlib.Path(folder) / "left").write_text("seen")
            hiding.cache_clear()
            roots = {SOURCE, BUILD, PREFIX.parent} | ({BUILD.parent} if BUILD.is_relative_to(SOURCE) else set())
            self.assertEqual(alone("find", *roots, "-path", PREFIX, "-prune", "-o", "-name", "left", "-print"), "")
        hiding.cache_clear()
        self.assertIn("parameters.h", alone("find", PREFIX, "-name", "*.h"))
        self.write("injected", "not hidden")
        self.assertEqual(alone("cat", self.folder / "injected"), "not hidden")


class Headers(Scratch):
    def test_headers_need_only_systemc_fmt_and_standard_library(self):
        self.assertEqual(foreign_includes(INCLUDE), [])
        self.write("spec/a.h", "#include <vector>\n#include <systemc>\n")
        self.write("rtl_model/a.h", '#include <tlm>\n#include <nlohmann/json.hpp>\n#include "tb/base/file.h"\n')
        self.assertEqual(foreign_includes(self.folder), ["rtl_model/a.h: nlohmann/json.hpp", "rtl_model/a.h: tb/base/file.h",
                                                         "spec/a.h: systemc"])

    def test_each_header_compiles_alone(self):
        golden, models = pkg_config("--cflags", "deburr-golden"), pkg_config("--cflags", "deburr-models")
        headers = sorted(file.relative_to(INCLUDE) for file in INCLUDE.rglob("*.h"))
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            said = pool.map(lambda header: compiles(header, models if header.parts[0] == "rtl_model" else golden), headers)
            wrong = {str(header): words for header, words in zip(headers, said) if words}
        self.assertEqual(wrong, {})
        self.write("leans.h", "#pragma once\ninline std::string name();\n")
        self.assertNotEqual(compiles("leans.h", [*golden, f"-I{self.folder}"]), "")


GOLDEN_MAIN = """#include "golden/morphological/morphological_golden.h"
int main() {
  deburr::spec::morphological::Parameters parameters;
  return deburr::golden::morphological::MorphologicalGolden(parameters).parameters().steps == parameters.steps ? 0 : 1;
}
"""
MODELS_MAIN = """#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_driver.h"
#include "rtl_model/texture/texture_unit.h"
int sc_main(int, char**) {
  const sc_core::sc_time period(2, sc_core::SC_NS);
  deburr::rtl::ClockDomain clock("clock", period);
  deburr::spec::texture::Parameters parameters;
  parameters.cache_fifo_depth = 32;
  deburr::rtl::texture::TextureUnit unit("unit", clock, parameters);
  deburr::platform::MemoryModel memory("memory", period);
  deburr::platform::RegisterHost host("host");
  host.bus.bind(unit.registers);
  unit.memory()->bind(memory.ports);
  deburr::rtl::Link<deburr::spec::texture::Quad> quads("quads");
  deburr::rtl::Link<deburr::spec::texture::ColourGroup> colours("colours");
  unit.quads_in(quads);
  unit.colours_out(colours);
  clock.run(10);
  deburr::platform::TextureDriver driver(host, memory);
  driver.identify();
  return driver.idle() ? 0 : 1;
}
"""


# As on a machine without SystemC: neither a library nor a CMake package.
NO_SYSTEMC = ("-DSystemC_LIBRARY=", "-DCMAKE_DISABLE_FIND_PACKAGE_SystemCLanguage=ON")


class Packages(Scratch):
    """find_package and pkg-config, called as a user would."""

    def test_golden_needs_no_systemc(self):
        here = pkg_config("--modversion", "deburr-golden")[0].rsplit(".", 1)[0]
        self.project(f"deburr {here} REQUIRED COMPONENTS golden", "deburr::golden", GOLDEN_MAIN)
        self.configure("-DCMAKE_DISABLE_FIND_PACKAGE_SystemC=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON")
        alone(CMAKE, "--build", self.folder / "build")
        call(self.folder / "build/user")

    def test_models_link_with_systemc(self):
        for version in ("3.25", "3.5"):  # sets the policies, as a caller of find_package does
            shutil.rmtree(self.folder / "build", ignore_errors=True)
            self.project("deburr REQUIRED COMPONENTS models", "deburr::models", MODELS_MAIN, version)
            self.configure()
            alone(CMAKE, "--build", self.folder / "build")
            call(self.folder / "build/user")

    def test_pkg_config_links_both_components(self):
        file = self.write("golden.cpp", GOLDEN_MAIN)
        call(CXX, file, "-o", self.folder / "golden", *pkg_config("--cflags", "--libs", "deburr-golden"))
        call(self.folder / "golden")
        self.write("main.cpp", MODELS_MAIN)
        self.as_on_the_page(block_of("howto/use_in_my_platform", "pkg-config"))
        call(self.folder / "a.out")
        self.assertEqual(pkg_config("--modversion", "deburr-golden"), pkg_config("--modversion", "deburr-models"))

    def test_version_ranges(self):
        """A version that lies in a range is accepted, whatever its second number."""
        here = pkg_config("--modversion", "deburr-golden")[0]
        major, minor, _ = map(int, here.split("."))
        for asked, found in (("0.1...<99", True), (f"{major}.{minor}...<{major}.{minor + 1}", True),
                             (f"0.1...{here}", True), (f"0.1...<{here}", False), (f"{major}.{minor + 1}...99", False), ("0.1", False),
                             (f"{major}.{minor}", True)):
            with self.subTest(asked):
                shutil.rmtree(self.folder / "build", ignore_errors=True)
                self.project(f"deburr {asked} REQUIRED COMPONENTS golden", "deburr::golden")
                said = self.configure(code=0 if found else 1)
                if not found:
                    self.assertIn(f"Deburr {asked} was asked for", said)

    def test_missing_component_is_reported(self):
        here = pkg_config("--modversion", "deburr-golden")[0]
        for find, options, words in (
                ("deburr 9.9 REQUIRED", [], ("libdeburr-dev", "9.9", here)),
                ("deburr 0.1 REQUIRED", [], ("libdeburr-dev", "0.1", here)),
                ("deburr REQUIRED COMPONENTS golden texture", [], ("no component texture", "golden and models")),
                ("deburr REQUIRED COMPONENTS models", NO_SYSTEMC, ("libsystemc-dev", "SYSTEMC_HOME")),
                ("deburr REQUIRED", NO_SYSTEMC, ("libsystemc-dev",)),
                ("deburr REQUIRED COMPONENTS models", ["-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON"], ("libfmt-dev",))):
            shutil.rmtree(self.folder / "build", ignore_errors=True)
            self.project(find)
            said = self.configure(*options, code=1)
            for word in words:
                self.assertIn(word, said, find)
        # A C project can use only the golden models.
        shutil.rmtree(self.folder / "build")
        self.write("main.c", "int main(void) { return 0; }")
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\nproject(user LANGUAGES C)\n"
                   "find_package(deburr REQUIRED)\nadd_executable(user main.c)\n")
        said = self.configure(code=1)
        self.assertIn("COMPONENTS golden", said)
        self.assertIn("needs the language C++, which this project has not", said)

    def test_optional_packages_may_be_absent(self):
        self.project("deburr REQUIRED COMPONENTS golden OPTIONAL_COMPONENTS models", "deburr::golden", GOLDEN_MAIN,
                     more='message("models: ${deburr_models_FOUND}")')
        for options, found in ((NO_SYSTEMC, "FALSE"), ((), "TRUE")):
            shutil.rmtree(self.folder / "build", ignore_errors=True)
            self.assertIn(f"models: {found}", self.configure(*options))


class Program(Scratch):
    def deburr(self, *arguments, code=0):
        return alone(PREFIX / "bin/deburr", *arguments, code=code, cwd=self.folder)

    def test_command_runs_from_its_prefix(self):
        self.assertIn("PASS texture", self.deburr("run", "texture", "--scene", "plane", "--size", "32x32", "--out", "out"))
        self.assertTrue((self.folder / "out/report.html").exists())

    def test_command_finds_files_next_to_it(self):
        self.deburr("run", "morphological", "--in", PREFIX / "share/deburr/docs/images/comparison.png", "--out", "out")
        said = self.deburr("papers", "nothing", "--out", "papers", code=2)
        self.assertNotIn("cannot be started", said)
        self.assertIn("nothing", said)

    def test_command_finds_ready_sweeps_and_testplans(self):
        self.assertIn("PASS sweep texture_cache", self.deburr("sweep", "sweeps/texture_cache.yaml", "plan"))
        self.assertIn("PASS", self.deburr("regress", "plan"))
        self.assertIn("PASS", self.deburr("regress", "tb/testplan/nightly.yaml", "plan", "--divide", "1000"))
        # The user's own file wins; a file that is nowhere is reported with the given name.
        self.write("sweeps/texture_cache.yaml", "title: mine\nengine: none\n")
        self.deburr("sweep", "sweeps/texture_cache.yaml", "plan", code=2)
        self.assertIn("sweeps/none.yaml", self.deburr("sweep", "sweeps/none.yaml", "plan", code=5))

    def test_manual_and_completion_match_the_program(self):
        manual = gzip.decompress((PREFIX / "share/man/man1/deburr.1.gz").read_bytes()).decode()
        self.assertEqual(manual, self.deburr("help", "--man"))
        commands = re.findall(r"^  ([a-z]+) ", self.deburr("--help").split("Subcommands:")[1].split("\n\n")[0], re.M)
        self.assertGreaterEqual(len(commands), 9)
        for command in commands:
            self.assertIn(f".SS deburr {command}\n", manual)
        if shutil.which("man"):
            self.assertIn("deburr regress", call("man", "-l", PREFIX / "share/man/man1/deburr.1.gz"))
        for shell, file in (("bash", "bash-completion/completions/deburr"), ("zsh", "zsh/vendor-completions/_deburr"),
                            ("fish", "fish/vendor_completions.d/deburr.fish")):
            self.assertEqual((PREFIX / "share" / file).read_text(encoding="utf-8"), self.deburr("completion", shell))
        self.assertEqual((INCLUDE / "deburr_registers.h").read_text(encoding="utf-8"), self.deburr("params", "--c-header"))


class Platform(Scratch):
    def test_page_builds_platform_which_finds_violations(self):
        said, shown = self.after_installing("howto/use_in_my_platform")
        self.assertEqual(not_printed(shown, said), [])
        self.assertRegex(shown, r"^PASS picture ")
        page = (PREFIX / "share/deburr/docs/howto/use_in_my_platform.md").read_text(encoding="utf-8")
        lines = [line.strip() for line in (EXAMPLES / "platform/main.cpp").read_text(encoding="utf-8").splitlines()]
        quoted = re.search(r"^```cpp\n(.*?)^```", page, re.M | re.S)[1]
        self.assertEqual([line for line in quoted.splitlines() if line.strip() not in lines], [])
        program = self.folder / "build/platform"
        said = alone(program, "--out", "picture.ppm", cwd=self.folder)
        self.assertIn("PASS picture", said)
        self.assertTrue((self.folder / "picture.ppm").read_bytes().startswith(b"P6"))
        # Every port transferred more than zero transactions.
        ports = re.findall(r"^(\w+) +(\d+) +(\d+) +(\d+) +(\d+)$", said, re.M)
        self.assertEqual(len(ports), 7, said)
        for name, blocking, non_blocking, length, _ in ports:
            self.assertGreater(int(blocking) + int(non_blocking), 0, name)
            self.assertGreater(int(length), 0, name)
        # A quantum changes the times of memory accesses by software, not those of register accesses.
        for quantum in (0, 50, 100_000):
            self.assertEqual(alone(program, "--quantum", quantum), said, quantum)
        violations = re.findall(r"^([\w-]+): (.*)$", alone(program, "--violations"), re.M)
        self.assertGreaterEqual(len(violations), 20)
        for name, rule in violations:
            found = alone(program, "--plant", name, code=1)
            self.assertRegex(found, rf"FAIL .*(software|texture)_bus: {rule}: ", name)

    def test_wrong_register_gives_wrong_picture(self):
        shutil.copytree(EXAMPLES / "platform", self.folder, dirs_exist_ok=True)
        software = (self.folder / "software.cpp").read_text(encoding="utf-8")
        self.assertIn("MAX_COUNT_LOG2, 3)", software)
        self.write("software.cpp", software.replace("MAX_COUNT_LOG2, 3)", "MAX_COUNT_LOG2, 0)"))
        self.configure()
        alone(CMAKE, "--build", self.folder / "build", "--parallel", os.cpu_count())
        self.assertRegex(alone(self.folder / "build/platform", code=1), r"FAIL picture .*: [1-9]\d* of 15360 pixels differ")


def exported(*command):
    """Functions and objects that a library exports with plain (unmangled) names."""
    return {line.split()[-1] for line in call(*command).splitlines() if re.search(r" [TDBRVWi] ", line)}


class C(Scratch):
    """The C interface, and the example in plain C."""

    def setUp(self):
        super().setUp()
        shutil.copytree(EXAMPLES / "c", self.folder, dirs_exist_ok=True)

    def drawn(self, program, **how):
        self.assertIn("PASS picture", alone(program, "picture.ppm", cwd=self.folder, **how))
        self.assertTrue((self.folder / "picture.ppm").read_bytes().startswith(b"P6"))

    def test_page_builds_example_without_cxx(self):
        self.assertIn("PASS picture", self.as_on_the_page(block_of("reference/c_interface", "examples/c")))
        self.assertTrue((self.folder / "picture.ppm").read_bytes().startswith(b"P6"))
        self.assertNotIn("CMAKE_CXX_COMPILER", (self.folder / "build/CMakeCache.txt").read_text(encoding="utf-8"))

    def test_one_line_build_detects_faults(self):
        flags = pkg_config("--cflags", "--libs", "deburr-golden-c")
        alone("cc", "-std=c99", self.folder / "draw.c", "-o", self.folder / "draw", *flags)
        self.drawn(self.folder / "draw")
        # A wrong picture and a failing call.
        draw = (self.folder / "draw.c").read_text(encoding="utf-8")
        for old, new, code, words in (('"axes", "eight"', '"axes", "two"', 1, "FAIL picture"),
                                      ('"preset", "deburr"', '"preset", "deblur"', 2, "draw: deburr_set: 'preset' = 'deblur'")):
            self.assertIn(old, draw)
            alone("cc", "-std=c99", self.write("wrong.c", draw.replace(old, new)), "-o", self.folder / "wrong", *flags)
            self.assertIn(words, alone(self.folder / "wrong", code=code))

    def test_every_function_is_exported(self):
        declared = set(DECLARED.findall((INCLUDE / "deburr_golden.h").read_text(encoding="utf-8")))
        self.assertGreater(len(declared), 30)
        found = exported("nm", "--defined-only", one_file("lib*/**/libdeburr-golden.*[ao]"))
        self.assertEqual({name for name in found if name.startswith("deburr_")}, declared)


# The quads of examples/systemverilog/testbench.sv, given to the C++ model.
QUADS_MAIN = """#include <cstdio>
#include <vector>
#include "golden/texture/texture_golden.h"
using namespace deburr;
int main() {
  std::uint32_t state = 1;
  const auto random = [&] { return state = state * 1664525 + 1013904223; };
  spec::texture::Descriptor d;
  d.width = d.height = 16;
  d.levels = 1;
  d.max_lod = 0;
  d.min_filter = spec::texture::MinFilter::kLinear;
  std::vector<std::uint8_t> memory(1024);
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x)
      for (std::uint32_t c = 0; c < 4; ++c)
        memory[golden::texture::texel_address(d, 0, static_cast<int>(x), static_cast<int>(y)) + c] =
            static_cast<std::uint8_t>(random() >> 24);
  golden::texture::TextureGolden golden(spec::texture::Parameters{}, memory);
  golden.set_texture(0, d);
  std::uint64_t hash = 14695981039346656037u;
  for (int i = 0; i < 1000000; ++i) {
    spec::texture::Quad quad;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      quad.s[lane] = static_cast<std::int32_t>(random());
      quad.t[lane] = static_cast<std::int32_t>(random());
    }
    for (const auto& colour : golden.process(quad))
      for (const std::uint8_t byte : colour.rgba) hash = (hash ^ byte) * 1099511628211u;
  }
  std::printf("%016llx\\n", static_cast<unsigned long long>(hash));
}
"""


@unittest.skipUnless(shutil.which("verilator"), "verilator is not installed: scripts/install examples")
class SystemVerilog(Scratch):
    """The SystemVerilog example, with Verilator."""

    def test_page_builds_testbench_which_finds_injected_faults(self):
        said, shown = self.after_installing("howto/testbench")
        self.assertEqual(not_printed(shown, said), [])
        self.assertRegex(said, r"(?m)^PASS$")
        injected, shown = blocks_of("howto/testbench")[2].split("\n", 1)
        self.assertRegex(injected, r"^make .* RUN=\+bug=\d$")
        self.assertEqual(not_printed(shown, self.as_on_the_page(injected, code=2)), [])
        self.assertRegex(said, r"edge detector: 20 frames, \d{4,} pixels with edges, 0 differ")
        # 10^6 calls, compared with what C++ computes for the same quads.
        alone(CXX, "-O2", self.write("quads.cpp", QUADS_MAIN), "-o", self.folder / "quads",
             *pkg_config("--cflags", "--libs", "deburr-golden"))
        self.assertIn("sampler: 1000000 quads, 4000000 colours, 0 differ, checksum " + call(self.folder / "quads"), said)
        program = self.folder / "systemverilog/build/testbench"
        for bug, words in ((1, "quad"), (2, "quad"), (3, "quad"), (4, "frame"), (5, "frame"), (6, "frame")):
            said = alone(program, f"+bug={bug}", "+quads=20000", code=-signal.SIGABRT)
            self.assertRegex(said, rf"FAIL {words} \d+, .* expected ", bug)
            self.assertNotRegex(said, r"(?m)^PASS$")
        said = alone(program, "+rejected", "+quads=10", "+frames=1")
        for words in ("status 1: deburr_set: 'depth_bias' = '99' is outside 1..24",
                      "status 1: deburr_frame_pixels: pixels_size is 8; 4 rows need 64",
                      "status 1: the handle is NULL", "parameters of the engine geometric: preset = deburr"):
            self.assertIn(words, said)

    @unittest.skipUnless(shutil.which("iverilog"), "iverilog is not installed: scripts/install examples")
    def test_another_simulator_compiles_the_devices(self):
        for name in ("bilinear_sampler", "edge_detector"):
            source = EXAMPLES / f"systemverilog/{name}.sv"
            call("iverilog", "-g2012", "-s", name, "-o", self.folder / "out", source)
            self.write("wrong.sv", source.read_text(encoding="utf-8").replace("always_ff", "always_fff", 1))
            call("iverilog", "-g2012", "-s", name, "-o", self.folder / "out", self.folder / "wrong.sv", code=range(1, 256))

    def test_prefix_without_deburr_is_reported(self):
        shutil.copytree(EXAMPLES / "systemverilog", self.folder, dirs_exist_ok=True)
        self.assertIn(f"no deburr-golden-c below {self.folder}", alone("make", f"PREFIX={self.folder}", cwd=self.folder, code=2))


NOTEBOOK = """import sys, nbclient, nbformat
notebook = nbformat.read("notebook.ipynb", as_version=4)
nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
nbformat.write(notebook, "executed.ipynb")
"""


@unittest.skipUnless(PYTHON_BUILT, "the Python module was not built: scripts/install python")
class Python(Scratch):
    """The Python module, its page and its notebook, with Debian's python3 and only the prefix."""

    def python(self, program, code=0):
        home = {"HOME": str(self.folder / "home"), "PYTHONPATH": str(PYTHON), "PYTHONDONTWRITEBYTECODE": "1"}
        return alone("/usr/bin/python3", "-c", program, code=code, cwd=self.folder, env=EMPTY | home)

    def test_installed_module_finds_its_command(self):
        said = self.python("import deburr, deburr._program as p; print(deburr.__file__, deburr._golden.__file__, p.program(), "
                           "deburr.__version__)").split()
        self.assertTrue(all(pathlib.Path(file).is_relative_to(PREFIX) for file in said[:3]), said)
        self.assertEqual(said[3:], pkg_config("--modversion", "deburr-golden"))
        self.assertTrue((PYTHON / "deburr/py.typed").exists())
        if pathlib.Path("/usr/bin/stubgen").exists():
            self.assertTrue({"golden.pyi", "ideal.pyi", "_golden/__init__.pyi", "_golden/ideal.pyi"}
                            <= {str(file.relative_to(PYTHON / "deburr")) for file in PYTHON.rglob("*.pyi")})
        self.assertEqual(sorted(file.name for file in PYTHON.rglob("*.py*") if file.is_symlink()), [])

    def test_page_names_the_installed_folder(self):
        calls = [line for block in blocks_of("reference/python") for line in block.splitlines()
                 if line.startswith("PYTHONPATH=~/deburr") and " -c " in line]
        self.assertEqual([self.as_on_the_page(line).split() for line in calls],
                         [pkg_config("--modversion", "deburr-golden")])

    def test_page_examples_print_what_it_shows(self):
        page = (PREFIX / "share/deburr/docs/reference/python.md").read_text(encoding="utf-8")
        programs = re.findall(r"```python\n(.*?)```", page, re.S)
        self.assertEqual(len(programs), 1)
        # A table that is wider than its page is printed without some columns.
        verdicts = "\nprint([point['state'] for point in getattr(table, 'to_dict', lambda _: table)('records')])"
        said = self.python(programs[0] + verdicts).splitlines()
        self.assertEqual(said[0], "(1080, 1920, 4) 0")
        cycles, rate, unit, misses = said[1].split()
        self.assertGreater(int(cycles), 320 * 240)
        self.assertGreater(float(rate), 0.5)
        self.assertGreater(float(misses), 100)
        self.assertTrue(unit.isidentifier())
        self.assertIn("texture.cache.bytes", said[2])
        self.assertEqual(said[-1], str(["done"] * 4), said)

    def test_python_golden_matches_c(self):
        """A frame of noise, through the module and through a C program."""
        c = self.write("noise.c", """#include <deburr_golden.h>
#include <stdio.h>
int main(void) {
  static uint8_t pixels[200 * 300 * 4];
  uint32_t s = 1;
  uint64_t hash = UINT64_C(14695981039346656037);
  deburr_golden* golden = deburr_morphological_new();
  for (size_t i = 0; i < sizeof pixels; ++i) pixels[i] = (uint8_t)((s = s * 1664525 + 1013904223) >> 24);
  if (deburr_set(golden, "preset", "smaa") || deburr_frame_begin(golden, 300, 200) ||
      deburr_frame_pixels(golden, pixels, sizeof pixels, 0) || deburr_frame_process(golden) ||
      deburr_plane(golden, "pixels", pixels, sizeof pixels, 0))
    return 1;
  for (size_t i = 0; i < sizeof pixels; ++i) hash = (hash ^ pixels[i]) * UINT64_C(1099511628211);
  printf("%016llx\\n", (unsigned long long)hash);
  return deburr_close(golden);
}
""")
        call("cc", "-std=c99", c, "-o", self.folder / "noise", *pkg_config("--cflags", "--libs", "deburr-golden-c"))
        said = self.python("""import deburr, numpy
s, values = 1, []
for _ in range(200 * 300 * 4):
    s = (s * 1664525 + 1013904223) % 2 ** 32
    values.append(s >> 24)
pixels = numpy.array(values, dtype=numpy.uint8).reshape(200, 300, 4)
value = 14695981039346656037
for byte in deburr.golden.morphological(pixels, preset="smaa").pixels.tobytes():
    value = (value ^ byte) * 1099511628211 % 2 ** 64
print(f"{value:016x}")
""")
        self.assertEqual(call(self.folder / "noise"), said)

    def hits(self, *settings):
        call(PREFIX / "bin/deburr", "run", "texture", "--out", "out", *settings, cwd=self.folder)
        work = json.loads((self.folder / "out/result.json").read_text(encoding="utf-8"))["work"]
        found = work["tag_stage_hits"] + work["tag_stage_merged"]
        return found / (found + work["tag_stage_misses"])

    def test_notebook_runs(self):
        try:
            self.python("import nbclient, ipykernel, pandas, matplotlib")
        except AssertionError:
            self.skipTest("a notebook's packages are not installed: scripts/install python")
        copies, executes = block_of("reference/python", "notebook.ipynb").splitlines()
        self.as_on_the_page(copies)
        self.python(NOTEBOOK)
        cells = json.loads((self.folder / "executed.ipynb").read_text(encoding="utf-8"))["cells"]
        outputs = [output for cell in cells for output in cell.get("outputs", [])]
        self.assertGreaterEqual(sum("image/png" in output.get("data", {}) for output in outputs), 3)
        text = "".join("".join(output.get("text", [])) for output in outputs)
        answer = re.search(r"ANSWER: (\d+) KiB, (\d) ways?: ([\d.]+) % hits", text)
        self.assertIsNotNone(answer, text)
        # The command confirms the answer: this cache reaches 97 %, half its size does not, with any number of ways.
        frame = ["--in", "hills.obj", "--size", "160x160", "--aniso", "8", "--texture", "brick", "--no-images",
                 "--set", "scene.texture_size=512", "--set", "memory.latency=200", "--set", "scene.eye=0.1,0.35,1.3",
                 "--set", "scene.target=0,-0.1,0"]
        kib, ways = int(answer[1]), answer[2]
        hits = self.hits(*frame, "--set", f"texture.cache.bytes={1024 * kib}", "--set", f"texture.cache.ways={ways}")
        self.assertEqual(f"{100 * hits:.2f}", answer[3])
        self.assertGreaterEqual(hits, 0.97)
        for less in ("1", "2", "4"):
            half = self.hits(*frame, "--set", f"texture.cache.bytes={512 * kib}", "--set", f"texture.cache.ways={less}")
            self.assertLess(half, 0.97)
        # Started as on the page, a wrong name ends it with the command's message.
        notebook = (self.folder / "notebook.ipynb").read_text(encoding="utf-8")
        self.assertIn("memory_latency=LATENCY", notebook)
        self.write("notebook.ipynb", notebook.replace("memory_latency=LATENCY", "memory_latncy=LATENCY"))
        self.assertIn("unknown parameter 'memory_latncy'", self.as_on_the_page(executes, code=1))


class Libraries(Scratch):
    def test_example_of_dramsys_needs_its_sources(self):
        said = call(CMAKE, "-S", EXAMPLES / "dramsys", "-B", self.folder, "-DDRAMSYS_SOURCE=/nowhere", code=1)
        self.assertIn("There is no DRAMSys at '/nowhere': set -DDRAMSYS_SOURCE", " ".join(said.split()))

    def test_libraries_configure_with_only_their_packages(self):
        """The preset `libraries`, where only the packages that scripts/packages.txt lists for it can be found."""
        sections = (SOURCE / "scripts/packages.txt").read_text(encoding="utf-8").split("\n\n")
        listed = next(section for section in sections if "[libraries build]" in section)
        self.assertIn("libsystemc-dev", listed)
        absent = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in (
            "OpenSSL", "yaml-cpp", "CLI11", "nlohmann_json", "ZLIB", "Imath", "tinyobjloader", "TinyGLTF", "OpenImageIO",
            "pagmo", "GTest", "benchmark", "Python", "Python3", "pybind11")]
        call(CMAKE, "--preset", "libraries", "-B", self.folder, *absent, cwd=SOURCE)
        commands = call("ninja", "-C", self.folder, "-t", "commands")
        self.assertIn("libdeburr-models.a", commands)
        self.assertNotRegex(commands, r" tb/")


def main():
    """Exits with 77, which ctest counts as skipped, if no test ran; a failure wins over skipped tests."""
    result = unittest.main(exit=False).result
    if result.wasSuccessful() and result.skipped and result.testsRun <= len(result.skipped):
        print(f"skipped: {result.skipped[0][1]}")
        sys.exit(77)
    sys.exit(not result.wasSuccessful())


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: MIT
# Libraries for other projects: libdeburr-golden and libdeburr-models, one archive each (or shared, BUILD_SHARED_LIBS)
# of all libraries of golden/ and of rtl_model/, their headers, the CMake package `deburr` and pkg-config files.
# Included before tb/, whose tests also have libraries of these layers.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(DEBURR_PACKAGE_FOLDER "${CMAKE_INSTALL_LIBDIR}/cmake/deburr")
# Sources include "spec/...", "golden/..." and "rtl_model/..."; user code does the same.
set(DEBURR_INCLUDE_FOLDER "${CMAKE_INSTALL_INCLUDEDIR}/deburr")

# deburr_installed_library(<component> <layer> [PUBLIC ...] [PRIVATE ...]): deburr::<component>, made of all libraries
# of the layer, and its link dependencies.
function(deburr_installed_library component layer)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  set(target deburr_${component})
  get_property(parts GLOBAL PROPERTY DEBURR_LIBRARIES_OF_${layer})
  list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  add_library(${target} ${objects})
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE CXX OUTPUT_NAME deburr-${component} EXPORT_NAME ${component}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} INTERFACE "$<INSTALL_INTERFACE:${DEBURR_INCLUDE_FOLDER}>")
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  install(TARGETS ${target} EXPORT deburr_${component}
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
  install(EXPORT deburr_${component} NAMESPACE deburr:: FILE deburr-${component}.cmake
    DESTINATION "${DEBURR_PACKAGE_FOLDER}" COMPONENT development)
endfunction()
deburr_installed_library(golden golden)
deburr_installed_library(models rtl_model PUBLIC SystemC::systemc PRIVATE fmt::fmt)

foreach(layer spec golden rtl_model)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/${layer}" DESTINATION "${DEBURR_INCLUDE_FOLDER}"
    COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "golden/c" EXCLUDE)
endforeach()

# The C interface belongs to libdeburr-golden: its header and the files that SystemVerilog needs. In a shared build it
# is also a separate library, which exports only this interface and keeps its version as long as no function changes.
get_target_property(header deburr_golden_c DEBURR_HEADER)
install(FILES "${header}" DESTINATION "${DEBURR_INCLUDE_FOLDER}"
  COMPONENT development)
set(DEBURR_SYSTEMVERILOG_FOLDER "${CMAKE_INSTALL_DATADIR}/deburr/systemverilog")
install(FILES "${PROJECT_SOURCE_DIR}/golden/c/systemverilog/deburr_golden_pkg.sv"
  "${PROJECT_SOURCE_DIR}/golden/c/systemverilog/deburr_golden_dpi.c"
  DESTINATION "${DEBURR_SYSTEMVERILOG_FOLDER}" COMPONENT development)
# For copying: each folder is a project of its own.
foreach(example c dramsys platform systemverilog)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples/${example}" DESTINATION "${CMAKE_INSTALL_DATADIR}/deburr/examples"
    COMPONENT development PATTERN build EXCLUDE)
endforeach()
if(BUILD_SHARED_LIBS)
  get_property(parts GLOBAL PROPERTY DEBURR_LIBRARIES_OF_golden)
  list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  set(exported "${CMAKE_CURRENT_LIST_DIR}/c_interface.map")
  add_library(deburr_c_library SHARED ${objects})
  set_target_properties(deburr_c_library PROPERTIES
    LINKER_LANGUAGE CXX OUTPUT_NAME deburr-golden-c EXPORT_NAME golden_c LINK_DEPENDS "${exported}"
    VERSION ${PROJECT_VERSION} SOVERSION 0)
  target_link_options(deburr_c_library PRIVATE "-Wl,--version-script=${exported}")
  target_include_directories(deburr_c_library INTERFACE "$<INSTALL_INTERFACE:${DEBURR_INCLUDE_FOLDER}>")
  install(TARGETS deburr_c_library EXPORT deburr_golden
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
endif()
# Libraries that a C program must link in addition to a C++ archive.
set(DEBURR_CXX_RUNTIME ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER DEBURR_CXX_RUNTIME INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|c\\+\\+abi|m)$")
list(REMOVE_DUPLICATES DEBURR_CXX_RUNTIME)

# The registers of every engine as a C header.
set(sections "")
set(includes "")
set(engines "")
set(sorted ${DEBURR_ENGINES})
list(SORT sorted)
foreach(engine ${sorted})
  if(EXISTS "${PROJECT_SOURCE_DIR}/rtl_model/${engine}/register_section.h")
    string(APPEND includes "#include \"rtl_model/${engine}/register_section.h\"\n")
    string(APPEND sections "      deburr::rtl::${engine}::register_section(),\n")
    list(APPEND engines deburr::rtl_${engine})
  endif()
endforeach()
set(DEBURR_REGISTERS_HEADER "${PROJECT_BINARY_DIR}/installed/deburr_registers.h")
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/installed/registers.cpp" @ONLY CONTENT [[
// Made by cmake/InstallLibraries.cmake: writes a C header of the registers of every engine.
#include <cstdio>
#include <string>
#include <vector>

#include "rtl_model/fabric/register_section.h"
@includes@
// SystemC's library asks for it.
extern "C" int sc_main(int /*argc*/, char** /*argv*/) { return 1; }

int main() {
  const std::vector<deburr::rtl::RegisterSection> sections = {
@sections@  };
  const std::string header = deburr::rtl::register_c_header(sections);
  const bool written = std::fwrite(header.data(), 1, header.size(), stdout) == header.size();
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}
]])
add_executable(deburr_registers "${PROJECT_BINARY_DIR}/installed/registers.cpp")
target_link_libraries(deburr_registers PRIVATE ${engines} deburr::fabric deburr_options)
add_custom_command(OUTPUT "${DEBURR_REGISTERS_HEADER}"
  COMMAND deburr_registers > "${DEBURR_REGISTERS_HEADER}" DEPENDS deburr_registers
  COMMENT "Writing the C header of the registers")
add_custom_target(deburr_registers_header ALL DEPENDS "${DEBURR_REGISTERS_HEADER}")
install(FILES "${DEBURR_REGISTERS_HEADER}" DESTINATION "${DEBURR_INCLUDE_FOLDER}" COMPONENT development)

# For find_package(deburr [version] COMPONENTS golden models).
set(package "${PROJECT_BINARY_DIR}/installed/cmake")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/package/deburr-config.cmake.in"
  "${package}/deburr-config.cmake" INSTALL_DESTINATION "${DEBURR_PACKAGE_FOLDER}"
  PATH_VARS DEBURR_INCLUDE_FOLDER DEBURR_SYSTEMVERILOG_FOLDER)
write_basic_package_version_file("${package}/deburr-version.cmake" COMPATIBILITY SameMinorVersion)
configure_file("${CMAKE_CURRENT_LIST_DIR}/package/deburr-config-version.cmake.in"
  "${package}/deburr-config-version.cmake" @ONLY)
install(FILES "${package}/deburr-config.cmake" "${package}/deburr-config-version.cmake"
  "${package}/deburr-version.cmake" "${CMAKE_CURRENT_LIST_DIR}/FindSystemC.cmake"
  DESTINATION "${DEBURR_PACKAGE_FOLDER}" COMPONENT development)

# deburr_pkg_config(<component> <description> [REQUIRES ...] [FLAGS ...] [LIBRARIES ...]): Deburr's own paths are
# relative to the file.
function(deburr_pkg_config component description)
  cmake_parse_arguments(ARG "" "" "REQUIRES;FLAGS;LIBRARIES" ${ARGN})
  if(NOT ARG_LIBRARIES)
    set(ARG_LIBRARIES deburr-${component})
  endif()
  list(TRANSFORM ARG_LIBRARIES PREPEND "-l" REGEX "^[^/]")
  list(JOIN ARG_LIBRARIES " " libraries)
  file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  string(REGEX REPLACE "/$" "" up "${up}")
  list(JOIN ARG_REQUIRES ", " requires)
  list(JOIN ARG_FLAGS " " flags)
  set(name deburr-${component})
  configure_file("${PROJECT_SOURCE_DIR}/cmake/package/deburr.pc.in"
    "${PROJECT_BINARY_DIR}/installed/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/installed/${name}.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
endfunction()
set(flags "")
if(SystemC_BASELINE AND NOT SystemC_BASELINE STREQUAL "native")
  set(flags "-DSC_CPLUSPLUS=${SystemC_BASELINE}")
endif()
deburr_pkg_config(golden "Bit-exact golden models of anti-aliasing hardware" FLAGS -std=c++20)
if(BUILD_SHARED_LIBS)
  set(libraries deburr-golden-c)
else()
  set(libraries deburr-golden ${DEBURR_CXX_RUNTIME})
endif()
deburr_pkg_config(golden-c "Bit-exact golden models of anti-aliasing hardware, for C and SystemVerilog"
  LIBRARIES ${libraries})
# SystemC's own CMake package, or a SYSTEMC_HOME, may have no systemc.pc.
set(requires systemc)
set(libraries "")
if(NOT PC_SystemC_FOUND)
  set(requires "")
  get_target_property(folders SystemC::systemc INTERFACE_INCLUDE_DIRECTORIES)
  list(TRANSFORM folders PREPEND "-I" OUTPUT_VARIABLE folders)
  list(APPEND flags ${folders})
  get_target_property(library SystemC::systemc LOCATION)
  set(libraries deburr-models "${library}" pthread)
endif()
# fmt: a static library does not record its dependencies.
deburr_pkg_config(models "Cycle-accurate SystemC models of anti-aliasing hardware"
  REQUIRES ${requires} fmt FLAGS -std=c++20 ${flags} LIBRARIES ${libraries})

# Everything that `cmake --install` copies.
add_custom_target(deburr_installed DEPENDS deburr_golden deburr_models deburr_registers_header)
if(TARGET deburr_c_library)
  add_dependencies(deburr_installed deburr_c_library)
endif()

# SPDX-License-Identifier: MIT
# Units of hdl/ and the tools that read them (option DEBURR_HDL). If a tool is absent, its tests are skipped with a
# message.
find_program(DEBURR_VERILATOR verilator)
find_program(DEBURR_MAKE make)
set(DEBURR_HDL_ROOT "${PROJECT_SOURCE_DIR}/hdl")
file(GLOB_RECURSE DEBURR_HDL_SOURCES CONFIGURE_DEPENDS "${DEBURR_HDL_ROOT}/*.sv" "${DEBURR_HDL_ROOT}/*.vlt")

# deburr_hdl_headers(<variable> <setting>...): the folder with the headers of a configuration, printed by the build
# (tb/hdl/print_headers.cpp) into hdl/generated of the build folder. They are never committed.
function(deburr_hdl_headers variable)
  string(JOIN "_" name defaults ${ARGN})
  string(REGEX REPLACE "[^a-z0-9_]" "_" name "${name}")
  set(folder "${PROJECT_BINARY_DIR}/hdl/generated/${name}")
  set(${variable} "${folder}" PARENT_SCOPE)
  get_property(known GLOBAL PROPERTY DEBURR_HDL_HEADERS)
  if(NOT folder IN_LIST known)
    set_property(GLOBAL APPEND PROPERTY DEBURR_HDL_HEADERS "${folder}")
    add_custom_command(OUTPUT "${folder}/tokens.svh" BYPRODUCTS "${folder}/tables.svh" "${folder}/descriptor.svh"
                       COMMAND deburr_hdl_headers "${folder}" ${ARGN} DEPENDS deburr_hdl_headers VERBATIM)
    add_custom_target(deburr_hdl_${name} DEPENDS "${folder}/tokens.svh")
  endif()
endfunction()

# deburr_hdl_model(<class> TOP <module> [SETTINGS <setting>...] [FAULT <file> <from> <to>]): a library with the module
# verilated as C++ class <class>, with these parameters of the texture unit. FAULT injects a fault into a copy of one
# source: it replaces <from>, which must occur exactly once, with <to>. Models without a fault can replace SystemC
# units in a run (deburr_hdl_counterparts).
function(deburr_hdl_model class)
  cmake_parse_arguments(ARG "" "TOP" "SETTINGS;FAULT" ${ARGN})
  deburr_hdl_headers(headers ${ARG_SETTINGS})
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${class}")
  set(paths -y "${DEBURR_HDL_ROOT}/fabric" -y "${DEBURR_HDL_ROOT}/texture")
  set(depends ${DEBURR_HDL_SOURCES} "${headers}/tokens.svh")
  if(ARG_FAULT)
    list(GET ARG_FAULT 0 file)
    cmake_path(GET file FILENAME name)
    set(faulty "${folder}_fault/${name}")
    add_custom_command(OUTPUT "${faulty}"
      COMMAND "${CMAKE_COMMAND}" -E rm -rf "${folder}_fault"  # the faulty file may have had another name
      COMMAND "${PROJECT_SOURCE_DIR}/tb/hdl/inject_fault.py" "${DEBURR_HDL_ROOT}/${file}" "${faulty}" ${ARG_FAULT}
      DEPENDS "${PROJECT_SOURCE_DIR}/tb/hdl/inject_fault.py" "${DEBURR_HDL_ROOT}/${file}" VERBATIM)
    set(paths -y "${folder}_fault" ${paths})
    list(APPEND depends "${faulty}")
  endif()
  # One file for the compiler: most of its time goes into headers.
  set(library "${folder}/${class}__ALL.a")
  add_custom_command(OUTPUT "${library}" BYPRODUCTS "${folder}/${class}.h"
    COMMAND "${DEBURR_VERILATOR}" --cc --Mdir "${folder}" --prefix ${class} --top-module ${ARG_TOP}
            -Wall --x-assign unique --x-initial unique "${DEBURR_HDL_ROOT}/lint.vlt" "-I${headers}" ${paths} ${ARG_TOP}
    COMMAND "${DEBURR_MAKE}" -s -C "${folder}" -f ${class}.mk ${class}__ALL.a
            "CXX=${CMAKE_CXX_COMPILER}" "OBJCACHE=${CMAKE_CXX_COMPILER_LAUNCHER}" VM_PARALLEL_BUILDS=0
            OPT_FAST=-O1 OPT_SLOW=-O1 OPT_GLOBAL=-O1
    DEPENDS ${depends} VERBATIM COMMENT "Verilating ${class}")
  add_custom_target(deburr_verilate_${class} DEPENDS "${library}")
  add_library(deburr_${class} INTERFACE)
  add_dependencies(deburr_${class} deburr_verilate_${class})
  target_include_directories(deburr_${class} SYSTEM INTERFACE "${folder}")
  target_link_libraries(deburr_${class} INTERFACE "${library}" deburr_verilated)
  list(JOIN ARG_SETTINGS " " settings)
  set_property(GLOBAL APPEND_STRING PROPERTY DEBURR_HDL_MODELS
               "inline constexpr const char* k${class} = \"${settings}\";\n")
  set_property(GLOBAL APPEND PROPERTY DEBURR_HDL_LIBRARIES deburr_${class})
  set_property(TARGET deburr_${class} PROPERTY DEBURR_HDL_TOP ${ARG_TOP})
  if(NOT ARG_FAULT)
    set_property(GLOBAL APPEND PROPERTY DEBURR_HDL_COUNTERPARTS ${class})
  endif()
endfunction()

# Sources that every verilated model needs.
function(deburr_hdl_runtime)
  get_filename_component(root "${DEBURR_VERILATOR}" REALPATH)
  cmake_path(GET root PARENT_PATH root)
  deburr_find(path DEBURR_VERILATOR_INCLUDE verilator NAMES verilated.h
              HINTS "${root}/../share/verilator/include")
  add_library(deburr_verilated STATIC "${DEBURR_VERILATOR_INCLUDE}/verilated.cpp"
                                      "${DEBURR_VERILATOR_INCLUDE}/verilated_threads.cpp")
  target_include_directories(deburr_verilated SYSTEM PUBLIC "${DEBURR_VERILATOR_INCLUDE}"
                                                            "${DEBURR_VERILATOR_INCLUDE}/vltstd")
  target_compile_features(deburr_verilated PUBLIC cxx_std_20)
  target_compile_options(deburr_verilated PRIVATE -w)
  deburr_find_package(Threads g++)
  target_link_libraries(deburr_verilated PUBLIC Threads::Threads)
endfunction()

# A header with the settings of all models, and a target that links the model libraries.
function(deburr_hdl_finish target)
  get_property(models GLOBAL PROPERTY DEBURR_HDL_MODELS)
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/models.h" @ONLY CONTENT
       "// SPDX-License-Identifier: MIT\n// Written by cmake/Hdl.cmake: the settings of each verilated model.\n\
#pragma once\n\nnamespace deburr::tb::hdl {\n${models}}  // namespace deburr::tb::hdl\n")
  get_property(libraries GLOBAL PROPERTY DEBURR_HDL_LIBRARIES)
  add_library(${target} INTERFACE)
  target_include_directories(${target} INTERFACE "${CMAKE_CURRENT_BINARY_DIR}")
  target_link_libraries(${target} INTERFACE ${libraries})
endfunction()

# deburr_hdl_counterparts(<name> LINK <library> CLASSES <class>...): an object that registers these models as RTL
# counterparts in the library's engine, for every program that links deburr_<name>.
function(deburr_hdl_counterparts name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "LINK" "CLASSES")
  set(includes "")
  set(calls "")
  set(libraries "")
  foreach(class ${ARG_CLASSES})
    get_target_property(top deburr_${class} DEBURR_HDL_TOP)
    string(APPEND includes "#include <${class}.h>\n")
    string(APPEND calls "  deburr::tb::hdl::add_${top}<${class}>(deburr::tb::hdl::k${class});\n")
    list(APPEND libraries deburr_${class})
  endforeach()
  set(file "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  file(CONFIGURE OUTPUT "${file}" @ONLY CONTENT "// SPDX-License-Identifier: MIT
// Written by cmake/Hdl.cmake.
${includes}#include <models.h>

#include \"tb/hdl/in_engine.h\"

namespace {

[[maybe_unused]] const bool added = [] {
${calls}  return true;
}();

}  // namespace
")
  add_library(deburr_${name}_object OBJECT "${file}")
  target_link_libraries(deburr_${name}_object PRIVATE ${ARG_LINK} ${libraries} deburr_options)
  target_include_directories(deburr_${name}_object PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
  add_library(deburr_${name} INTERFACE)
  target_link_libraries(deburr_${name} INTERFACE $<TARGET_OBJECTS:deburr_${name}_object> ${libraries}
                                                 ${ARG_LINK})
endfunction()

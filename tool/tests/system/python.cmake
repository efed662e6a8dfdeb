# SPDX-License-Identifier: MIT
# The Python module of this build, if there is one (python/CMakeLists.txt).
if(TARGET deburr_python)
  add_dependencies(deburr_system_tests deburr_python)
  set(modules "${PROJECT_BINARY_DIR}/python")
  foreach(class Vectors Texture Ideal Layouts BadCalls Pickle Threads Declarations)
    add_test(NAME python_golden.${class} COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/python_golden_test.py" "${modules}"
                                                 "${PROJECT_SOURCE_DIR}/docs" ${class})
    set_tests_properties(python_golden.${class} PROPERTIES LABELS system TIMEOUT 300)
  endforeach()
  foreach(class Runs Errors Interrupted Sweeps)
    add_test(NAME python_run.${class} COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/python_run_test.py" "${modules}" ${class})
    set_tests_properties(python_run.${class} PROPERTIES LABELS system TIMEOUT 300)
  endforeach()
  if(TARGET deburr_python_stubs)
    add_dependencies(deburr_system_tests deburr_python_stubs)
    add_test(NAME python_stubs COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/python_stubs_test.py" "${modules}"
                                       "${PROJECT_SOURCE_DIR}/docs")
    set_tests_properties(python_stubs PROPERTIES LABELS system TIMEOUT 300)
  endif()
endif()

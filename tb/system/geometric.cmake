# SPDX-License-Identifier: MIT
foreach(suite system stress coverage)
  if(suite STREQUAL stress)
    set(label stress)
  else()
    set(label system)
  endif()
  deburr_test(geometric_${suite}_test PROGRAM system_geometric_tests LABELS ${label}
              SOURCE geometric_${suite}_test.cpp
              LINK deburr::geometric_environment TIMEOUT 300)
endforeach()
add_test(NAME geometric_clocks
         COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/geometric_clocks_test.py" $<TARGET_FILE:geometric_rtl_bench>)
set_tests_properties(geometric_clocks PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
add_test(NAME geometric_figures
         COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/geometric_test.py" $<TARGET_FILE:deburr> "${PROJECT_SOURCE_DIR}")
set_tests_properties(geometric_figures PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
add_dependencies(deburr_system_tests geometric_rtl_bench deburr)

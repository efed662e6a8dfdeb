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
deburr_script_test(geometric_cycles ARGUMENTS $<TARGET_FILE:geometric_rtl_bench>)
add_dependencies(deburr_system_tests geometric_rtl_bench)

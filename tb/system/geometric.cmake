# SPDX-License-Identifier: MIT
foreach(suite system stress coverage)
  if(suite STREQUAL stress)
    set(label stress)
  else()
    set(label system)
  endif()
  deburr_test(geometric_${suite}_test LABELS ${label} SOURCES geometric_${suite}_test.cpp
              LINK deburr::geometric_environment TIMEOUT 300)
  target_compile_definitions(geometric_${suite}_test
                             PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
endforeach()

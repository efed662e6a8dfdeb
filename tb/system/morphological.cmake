# SPDX-License-Identifier: MIT
foreach(suite system stress coverage records shares)
  if(suite STREQUAL stress)
    set(label stress)
  elseif(suite STREQUAL records)
    set(label negative)
  else()
    set(label system)
  endif()
  deburr_test(morphological_${suite}_test PROGRAM system_morphological_tests LABELS ${label}
              SOURCE morphological_${suite}_test.cpp
              LINK deburr::morphological_environment TIMEOUT 300)
endforeach()

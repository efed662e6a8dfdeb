# SPDX-License-Identifier: MIT
# Two presets always run full frames of 1080 lines; all presets run those of 720.
set(LONG_system "Morphological/RenderedFrame[.].*/(mlaa_1|mlaa_slope_3|smaa_dynamic_7|deburr_line_9)")
foreach(suite system stress coverage records weights)
  if(suite STREQUAL stress)
    set(label stress)
  elseif(suite STREQUAL records)
    set(label negative)
  else()
    set(label system)
  endif()
  deburr_test(morphological_${suite}_test PROGRAM system_morphological_tests LABELS ${label} LONG ${LONG_${suite}}
              SOURCE morphological_${suite}_test.cpp
              LINK deburr::morphological_environment TIMEOUT 300)
endforeach()

# SPDX-License-Identifier: MIT
# The morphological engine's hardware model: vectors of the contract, values by hand, clocks as
# documented.
foreach(part vectors blocks timing engine)
  deburr_test(morphological_rtl_${part}_test LABELS unit timing
              SOURCES morphological_rtl_${part}_test.cpp
              LINK deburr::rtl_morphological deburr::harness)
endforeach()

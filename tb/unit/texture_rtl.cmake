# SPDX-License-Identifier: MIT
# Blocks of the texture unit's hardware model: values by hand from the contract, clocks as documented.
foreach(part address cache filter)
  deburr_test(texture_rtl_${part}_test LABELS unit timing
              SOURCES texture_rtl_${part}_test.cpp LINK deburr::rtl_texture deburr::harness)
endforeach()
deburr_test(texture_rtl_unit_test LABELS unit timing
            SOURCES texture_rtl_unit_test.cpp LINK deburr::rtl_texture deburr::harness)

# SPDX-License-Identifier: MIT
# The texture unit's reference against its formulas and against real arithmetic.
deburr_library(texture_golden_support LAYER tb LINK deburr::golden_texture)
deburr_test(texture_tables_test LABELS unit
            SOURCES "${CMAKE_CURRENT_LIST_DIR}/texture_tables_test.cpp"
            LINK deburr::texture_golden_support)
foreach(part footprint log2 level sampling address filter cache unit)
  deburr_test(texture_golden_${part}_test LABELS unit
              SOURCES "${CMAKE_CURRENT_LIST_DIR}/texture_golden_${part}_test.cpp"
              LINK deburr::texture_golden_support deburr::ideal)
endforeach()
deburr_test(texture_golden_ideal_test LABELS unit oracle
            SOURCES "${CMAKE_CURRENT_LIST_DIR}/texture_golden_ideal_test.cpp"
            LINK deburr::texture_golden_support deburr::ideal)
deburr_test(texture_golden_quality_test LABELS oracle TIMEOUT 600
            SOURCES "${CMAKE_CURRENT_LIST_DIR}/texture_golden_quality_test.cpp"
            LINK deburr::texture_golden_support deburr::ideal)

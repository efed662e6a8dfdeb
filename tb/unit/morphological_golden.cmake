# SPDX-License-Identifier: MIT
foreach(part vectors edges runs blend frames coverage)
  deburr_test(morphological_golden_${part}_test LABELS unit
    SOURCES "${CMAKE_CURRENT_LIST_DIR}/morphological_golden_${part}_test.cpp"
    LINK deburr::golden_morphological)
  deburr_layer_root(deburr_tb_root tb)
  target_include_directories(morphological_golden_${part}_test PRIVATE "${deburr_tb_root}")
endforeach()

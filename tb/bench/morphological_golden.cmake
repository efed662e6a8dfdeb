# SPDX-License-Identifier: MIT
find_package(benchmark REQUIRED)
add_executable(morphological_golden_bench "${CMAKE_CURRENT_LIST_DIR}/morphological_golden_bench.cpp")
deburr_layer_root(deburr_tb_root tb)
target_include_directories(morphological_golden_bench PRIVATE "${deburr_tb_root}")
target_link_libraries(morphological_golden_bench
  PRIVATE deburr::golden_morphological deburr_options benchmark::benchmark)

# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(morphological_golden_bench "${CMAKE_CURRENT_LIST_DIR}/morphological_golden_bench.cpp")
target_link_libraries(morphological_golden_bench
  PRIVATE deburr::golden_morphological deburr::stimuli deburr_options benchmark::benchmark)

# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(geometric_golden_bench "${CMAKE_CURRENT_LIST_DIR}/geometric_golden_bench.cpp")
target_link_libraries(geometric_golden_bench
  PRIVATE deburr::geometric_frames deburr_options benchmark::benchmark)

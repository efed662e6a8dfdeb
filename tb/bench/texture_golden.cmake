# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(texture_golden_bench "${CMAKE_CURRENT_LIST_DIR}/texture_golden_bench.cpp")
target_link_libraries(texture_golden_bench PRIVATE deburr::texture_golden_support deburr_options
                                                   benchmark::benchmark)

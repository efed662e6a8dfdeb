# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(fabric_bench "${CMAKE_CURRENT_LIST_DIR}/fabric_bench.cpp")
target_link_libraries(fabric_bench PRIVATE deburr::harness benchmark::benchmark deburr_options)

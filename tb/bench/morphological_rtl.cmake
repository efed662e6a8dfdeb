# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(morphological_rtl_bench "${CMAKE_CURRENT_LIST_DIR}/morphological_rtl_bench.cpp")
target_link_libraries(morphological_rtl_bench PRIVATE deburr::rtl_morphological
                                                      deburr::golden_morphological deburr::harness
                                                      benchmark::benchmark deburr_options)

# SPDX-License-Identifier: MIT
deburr_find_package(benchmark libbenchmark-dev)
add_executable(texture_rtl_bench "${CMAKE_CURRENT_LIST_DIR}/texture_rtl_bench.cpp")
target_link_libraries(texture_rtl_bench PRIVATE deburr::rtl_texture deburr::harness deburr::golden_texture
                                                benchmark::benchmark deburr_options)

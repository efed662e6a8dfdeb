# SPDX-License-Identifier: MIT
add_executable(geometric_rtl_bench "${CMAKE_CURRENT_LIST_DIR}/geometric_rtl_bench.cpp")
target_link_libraries(geometric_rtl_bench PRIVATE deburr::rtl_geometric deburr::golden_geometric
                                                  deburr::harness deburr_options)
add_dependencies(deburr_long_tests geometric_rtl_bench)  # run by the test report

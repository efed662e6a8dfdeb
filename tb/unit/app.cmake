# SPDX-License-Identifier: MIT
deburr_test(app_parameters LABELS unit SOURCES app_parameters_test.cpp LINK GTest::gmock_main deburr::results)
deburr_test(app_results LABELS unit SOURCES app_results_test.cpp LINK GTest::gmock_main deburr::results)

# SPDX-License-Identifier: MIT
deburr_test(texture_system_test LABELS system SOURCES texture_system_test.cpp
            LINK deburr::texture_environment)
target_compile_definitions(texture_system_test PRIVATE DEBURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
deburr_test(texture_stress_test LABELS stress SOURCES texture_stress_test.cpp
            LINK deburr::texture_environment TIMEOUT 300)
deburr_test(texture_coverage_test LABELS system SOURCES texture_coverage_test.cpp
            LINK deburr::texture_environment)
deburr_test(texture_random_test LABELS system SOURCES texture_random_test.cpp
            LINK deburr::golden_texture deburr::harness deburr::rtl_texture)
deburr_test(texture_limits_test LABELS system SOURCES texture_limits_test.cpp
            LINK deburr::golden_texture deburr::harness deburr::rtl_texture)
deburr_test(texture_targets_test LABELS system SOURCES texture_targets_test.cpp
            LINK deburr::texture_environment)

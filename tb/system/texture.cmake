# SPDX-License-Identifier: MIT
deburr_test(texture_system_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_system_test.cpp
            LINK deburr::texture_environment)
deburr_test(texture_stress_test PROGRAM system_texture_tests LABELS stress
            SOURCE texture_stress_test.cpp
            LINK deburr::texture_environment TIMEOUT 300)
deburr_test(texture_coverage_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_coverage_test.cpp
            LINK deburr::texture_environment)
deburr_test(texture_random_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_random_test.cpp
            LINK deburr::golden_texture deburr::harness deburr::rtl_texture)
deburr_test(texture_limits_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_limits_test.cpp
            LINK deburr::golden_texture deburr::harness deburr::rtl_texture)
deburr_test(texture_targets_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_targets_test.cpp
            LINK deburr::texture_environment)
deburr_test(texture_width_test PROGRAM system_texture_tests LABELS system
            SOURCE texture_width_test.cpp
            LINK deburr::texture_environment)

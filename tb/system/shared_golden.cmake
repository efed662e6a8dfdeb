# SPDX-License-Identifier: MIT
deburr_test(shared_golden_test PROGRAM system_app_tests LABELS negative SOURCE shared_golden_test.cpp
            LINK deburr::morphological_environment deburr::pages deburr::texture_environment)

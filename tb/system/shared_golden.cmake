# SPDX-License-Identifier: MIT
deburr_test(shared_golden_test LABELS negative SOURCES shared_golden_test.cpp LINK deburr::engines)

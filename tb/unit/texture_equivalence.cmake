# SPDX-License-Identifier: MIT
# Each block of the texture unit against the function of the golden model that says what it does.
deburr_test(texture_equivalence_test LABELS unit
            SOURCES texture_equivalence_test.cpp
            LINK deburr::rtl_texture deburr::golden_texture deburr::harness)

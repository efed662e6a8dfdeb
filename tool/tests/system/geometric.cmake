# SPDX-License-Identifier: MIT
deburr_script_test(geometric_figures ARGUMENTS $<TARGET_FILE:deburr> "${PROJECT_SOURCE_DIR}")

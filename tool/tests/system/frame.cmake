# SPDX-License-Identifier: MIT
deburr_script_test(smoothing ARGUMENTS $<TARGET_FILE:deburr> "${PROJECT_SOURCE_DIR}")

# SPDX-License-Identifier: MIT
add_test(NAME smoothing COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/frame_test.py" $<TARGET_FILE:deburr>
                                "${PROJECT_SOURCE_DIR}")
set_tests_properties(smoothing PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")

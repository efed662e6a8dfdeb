# SPDX-License-Identifier: MIT
add_test(NAME papers COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/papers_test.py" $<TARGET_FILE:deburr>)
set_tests_properties(papers PROPERTIES LABELS "system;long" TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")

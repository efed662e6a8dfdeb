# SPDX-License-Identifier: MIT
# The scripts of the repository.
add_test(NAME mutate COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/mutate_test.py" "${PROJECT_SOURCE_DIR}")
set_tests_properties(mutate PROPERTIES LABELS tools TIMEOUT 120)

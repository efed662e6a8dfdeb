# SPDX-License-Identifier: MIT
add_test(NAME layers COMMAND ${PROJECT_SOURCE_DIR}/tb/unit/layers_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(layers PROPERTIES LABELS unit)

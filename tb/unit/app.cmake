# SPDX-License-Identifier: MIT
deburr_test(app_parameters LABELS unit SOURCES app_parameters_test.cpp LINK deburr::results)
deburr_test(app_scene LABELS unit SOURCES app_scene_test.cpp LINK deburr::texture_scene)
deburr_test(app_results LABELS unit SOURCES app_results_test.cpp LINK deburr::results)
deburr_test(app_pictures LABELS unit SOURCES app_pictures_test.cpp LINK deburr::app)
add_test(NAME app_pages
         COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_pages_test.py" $<TARGET_FILE:deburr> "${PROJECT_SOURCE_DIR}")
set_tests_properties(app_pages PROPERTIES LABELS unit)

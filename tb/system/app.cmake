# SPDX-License-Identifier: MIT
add_dependencies(deburr_system_tests deburr_complete)
add_dependencies(deburr_slurm_tests deburr_complete)
deburr_test(app_report_test PROGRAM system_app_tests LABELS system SOURCE app_report_test.cpp
            LINK deburr::results TIMEOUT 300)
deburr_test(app_reset_test PROGRAM system_app_reset_tests LABELS stress SOURCE app_reset_test.cpp
            LINK deburr::engines TIMEOUT 300)
add_test(NAME memories COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/memories_test.py" $<TARGET_FILE:deburr>
                               "${PROJECT_SOURCE_DIR}/docs")
set_tests_properties(memories PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
foreach(class Terminal LastLine Help Documents Bar Lines Completion CompletionZsh TypedZsh CompletionFish)
  add_test(NAME terminal.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/terminal_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(terminal.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
add_test(NAME figures COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/figures_test.py" $<TARGET_FILE:deburr>)
set_tests_properties(figures PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
add_test(NAME pixel_history COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/pixel_history_test.py" $<TARGET_FILE:deburr>)
set_tests_properties(pixel_history PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
add_test(NAME coverage COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/coverage_test.py" $<TARGET_FILE:deburr>
                               "${PROJECT_SOURCE_DIR}")
set_tests_properties(coverage PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
foreach(class Unseen Slower Reset Faulty)
  add_test(NAME disturbed.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/disturbed_test.py" $<TARGET_FILE:deburr> "${PROJECT_SOURCE_DIR}" ${class})
  set_tests_properties(disturbed.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
foreach(class Windows Timeline Maps)
  add_test(NAME observers.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/observers_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(observers.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
foreach(class Runs Sweeps Regressions)
  add_test(NAME report_pages.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/report_pages_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(report_pages.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
foreach(class Images Meshes)
  add_test(NAME sequence.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/sequence_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(sequence.${class} PROPERTIES LABELS system TIMEOUT 300
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
foreach(class Points Searched Failing Killed)
  add_test(NAME sweep.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/sweep_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(sweep.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
foreach(class Lines Forms Fragments)
  add_test(NAME traces.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/traces_test.py" $<TARGET_FILE:deburr>
                   "${PROJECT_SOURCE_DIR}/docs/reference/traces.md" ${class})
  set_tests_properties(traces.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
add_test(NAME guide_pictures COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/guide_pictures_test.py" $<TARGET_FILE:deburr>
                                     "${PROJECT_SOURCE_DIR}")
set_tests_properties(guide_pictures PROPERTIES LABELS system TIMEOUT 300)
add_test(NAME first_sweep COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/first_sweep_test.py" $<TARGET_FILE:deburr>
                                  "${PROJECT_SOURCE_DIR}")
set_tests_properties(first_sweep PROPERTIES LABELS system TIMEOUT 600
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
add_test(NAME printed COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/printed_test.py" $<TARGET_FILE:deburr>
                              "${PROJECT_SOURCE_DIR}")
set_tests_properties(printed PROPERTIES LABELS system TIMEOUT 600)
add_test(NAME testplans COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/testplans_test.py" $<TARGET_FILE:deburr>
                                "${PROJECT_SOURCE_DIR}")
set_tests_properties(testplans PROPERTIES LABELS system TIMEOUT 300
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
set_property(TEST sweep.Killed APPEND PROPERTY LABELS long)
add_dependencies(deburr_long_tests deburr_complete)
foreach(class Replaced Traced)
  add_test(NAME inputs.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/inputs_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(inputs.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()
add_test(NAME slurm COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/slurm_test.py" $<TARGET_FILE:deburr>)
set_tests_properties(slurm PROPERTIES LABELS slurm TIMEOUT 900 SKIP_REGULAR_EXPRESSION "^skipped"
                     ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
foreach(class Passing Failing Killed)
  add_test(NAME regress.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/regress_test.py" $<TARGET_FILE:deburr> ${class})
  set_tests_properties(regress.${class} PROPERTIES LABELS system TIMEOUT 600
                       ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1")
endforeach()

# SPDX-License-Identifier: MIT
# One ctest entry a class, so that they run side by side.
add_dependencies(deburr_negative_tests deburr_complete)
add_dependencies(deburr_stress_tests deburr_complete)
foreach(class TextureFiles MeshFiles Notes Configuration Output EarlierResults StandardOutput Interruption
              Results)
  add_test(NAME app_bad_input.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_bad_input_test.py" -v ${class})
  list(APPEND APP_NEGATIVE_TESTS app_bad_input.${class})
endforeach()
foreach(class Faults Registers Blind)
  add_test(NAME app_faults.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_faults_test.py" -v ${class})
  list(APPEND APP_NEGATIVE_TESTS app_faults.${class})
endforeach()
foreach(class Definitions Searches Surroundings)
  add_test(NAME app_sweep.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_sweep_test.py" -v ${class})
  list(APPEND APP_NEGATIVE_TESTS app_sweep.${class})
endforeach()
foreach(class Fragments Lines)
  add_test(NAME app_traces.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_traces_test.py" -v ${class})
  list(APPEND APP_NEGATIVE_TESTS app_traces.${class})
endforeach()
foreach(class Trains Rejects)
  add_test(NAME app_train.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_train_test.py" -v ${class})
  list(APPEND APP_NEGATIVE_TESTS app_train.${class})
endforeach()
add_test(NAME app_regress COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_regress_test.py" -v)
add_test(NAME app_images COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_images_test.py" -v)
set_tests_properties(${APP_NEGATIVE_TESTS} app_images app_regress PROPERTIES
  LABELS negative TIMEOUT 300 ENVIRONMENT "DEBURR=$<TARGET_FILE:deburr>;PYTHONDONTWRITEBYTECODE=1")
foreach(class Killed SideBySide FullDisk Papers)
  add_test(NAME app_survival.${class}
           COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/app_survival_test.py" -v ${class})
  set_tests_properties(app_survival.${class} PROPERTIES LABELS stress TIMEOUT 900
    ENVIRONMENT "DEBURR=$<TARGET_FILE:deburr>;PYTHONDONTWRITEBYTECODE=1")
endforeach()
set_property(TEST app_survival.Killed app_survival.FullDisk app_survival.Papers
             APPEND PROPERTY LABELS long)

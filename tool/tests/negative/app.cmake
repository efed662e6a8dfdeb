# SPDX-License-Identifier: MIT
add_dependencies(deburr_negative_tests deburr_complete)
add_dependencies(deburr_stress_tests deburr_complete)
set(options ENVIRONMENT DEBURR=$<TARGET_FILE:deburr> ARGUMENTS -v)
deburr_script_test(app_bad_input LABELS negative ${options}
  CLASSES TextureFiles MeshFiles CompressedFormats Notes Configuration Output EarlierResults StandardOutput Interruption Results)
deburr_script_test(app_faults LABELS negative ${options} CLASSES Faults Registers Figures Fields Blind)
deburr_script_test(app_sweep LABELS negative ${options} CLASSES Definitions Searches Surroundings)
deburr_script_test(app_traces LABELS negative ${options} CLASSES Fragments Lines)
deburr_script_test(app_regress LABELS negative ${options})
deburr_script_test(app_images LABELS negative ${options})
deburr_script_test(app_survival LABELS stress TIMEOUT 900 ${options} CLASSES Killed SideBySide FullDisk Papers)
set_property(TEST app_survival.Killed app_survival.FullDisk app_survival.Papers
             APPEND PROPERTY LABELS long)

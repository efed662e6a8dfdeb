# SPDX-License-Identifier: MIT
deburr_script_test(morphological_negative FILE morphological LABELS negative ENVIRONMENT DEBURR=$<TARGET_FILE:deburr> ARGUMENTS -v
  CLASSES Frames Configuration Faults WeightsFaults GuardFaults Fields SmaaFaults)

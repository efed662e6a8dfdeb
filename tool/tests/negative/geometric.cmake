# SPDX-License-Identifier: MIT
deburr_script_test(geometric_negative FILE geometric LABELS negative ENVIRONMENT DEBURR=$<TARGET_FILE:deburr> ARGUMENTS -v
  CLASSES Meshes Configuration Faults Registers Fields Blind)

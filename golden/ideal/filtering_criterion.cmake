# SPDX-License-Identifier: MIT
# Khronos's filtering criterion: real arithmetic; independent of the golden model that it checks.
deburr_library(filtering_criterion LAYER golden
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/filtering_criterion.cpp"
  LINK deburr::spec)

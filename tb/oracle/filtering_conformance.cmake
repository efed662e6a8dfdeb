# SPDX-License-Identifier: MIT
deburr_library(conformance LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/conformance.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/encoded_texture.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/filtering_cases.cpp"
          "${CMAKE_CURRENT_LIST_DIR}/plain_sampler.cpp"
  LINK deburr::spec deburr::golden_texture deburr::filtering_criterion
  PRIVATE_LINK fmt::fmt)

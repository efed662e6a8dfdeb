# SPDX-License-Identifier: MIT
# What the texture unit's rules are worth on a photograph, seen by a turned camera.
deburr_library(turned_photo LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/turned_photo.cpp"
  LINK deburr::golden_texture deburr::ideal deburr::scene deburr::texture_memory)

# SPDX-License-Identifier: MIT
# What the texture unit's rules are worth on a photograph, seen by a turned and by a moving camera.
deburr_library(turned_photo LAYER tb
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/turned_photo.cpp"
  LINK deburr::golden_texture deburr::ideal deburr::scene deburr::drivers)
deburr_test(texture_direction_test LABELS oracle TIMEOUT 600
  LONG TextureDirection[.].*/[bg]
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/texture_direction_test.cpp"
  LINK deburr::turned_photo)
deburr_test(texture_flicker_test LABELS oracle TIMEOUT 600
  LONG TextureFlickerOnPhotographs[.].*/[gr]
  SOURCE "${CMAKE_CURRENT_LIST_DIR}/texture_flicker_test.cpp"
  LINK deburr::ideal deburr::texture_environment)

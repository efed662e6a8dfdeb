/* SPDX-License-Identifier: MIT */
/* Converts the open arrays and strings of deburr_golden_pkg.sv for libdeburr-golden. Generated from
 * deburr_golden.h. Compile it with the simulator's svdpi.h. */
#include <svdpi.h>

#include "deburr_golden.h"

/* Returned text; the simulator copies it when the function returns. */
#ifdef __cplusplus
extern "C" {
#define OF_THREAD thread_local
#else
#define OF_THREAD _Thread_local
#endif
static OF_THREAD char text_of_thread[4096];

int deburr_dpi_error(void* golden, int status, const char** text) {
  text_of_thread[0] = '\0';
  *text = text_of_thread;
  return deburr_error((deburr_golden*)golden, status, text_of_thread, sizeof text_of_thread);
}

int deburr_dpi_get(void* golden, const char* name, const char** text) {
  text_of_thread[0] = '\0';
  *text = text_of_thread;
  return deburr_get((deburr_golden*)golden, name, text_of_thread, sizeof text_of_thread);
}

int deburr_dpi_parameter_name(void* golden, uint32_t index, const char** text) {
  text_of_thread[0] = '\0';
  *text = text_of_thread;
  return deburr_parameter_name((deburr_golden*)golden, index,
      text_of_thread, sizeof text_of_thread);
}

int deburr_dpi_counter_name(void* golden, uint32_t index, const char** text) {
  text_of_thread[0] = '\0';
  *text = text_of_thread;
  return deburr_counter_name((deburr_golden*)golden, index, text_of_thread, sizeof text_of_thread);
}

int deburr_dpi_error_lines(void* golden, const svOpenArrayHandle lines) {
  return deburr_error_lines((deburr_golden*)golden,
      (const uint32_t*)svGetArrayPtr(lines), (size_t)svSize(lines, 1));
}

int deburr_dpi_frame_pixels(void* golden, const svOpenArrayHandle pixels, uint32_t stride) {
  return deburr_frame_pixels((deburr_golden*)golden,
      (const uint8_t*)svGetArrayPtr(pixels), (size_t)svSize(pixels, 1), stride);
}

int deburr_dpi_frame_depth(void* golden, const svOpenArrayHandle depth, uint32_t stride) {
  return deburr_frame_depth((deburr_golden*)golden,
      (const uint32_t*)svGetArrayPtr(depth), (size_t)svSize(depth, 1), stride);
}

int deburr_dpi_plane(void* golden, const char* plane, const svOpenArrayHandle values,
      uint32_t stride) {
  return deburr_plane((deburr_golden*)golden, plane,
      (uint8_t*)svGetArrayPtr(values), (size_t)svSize(values, 1), stride);
}

int deburr_dpi_texture_write(void* golden, uint64_t address, const svOpenArrayHandle bytes) {
  return deburr_texture_write((deburr_golden*)golden, address,
      (const uint8_t*)svGetArrayPtr(bytes), (size_t)svSize(bytes, 1));
}

int deburr_dpi_texture_read(void* golden, uint64_t address, const svOpenArrayHandle bytes) {
  return deburr_texture_read((deburr_golden*)golden, address,
      (uint8_t*)svGetArrayPtr(bytes), (size_t)svSize(bytes, 1));
}

int deburr_dpi_texture_level(void* golden, uint32_t texture, uint32_t level,
      const svOpenArrayHandle texels, uint32_t stride) {
  return deburr_texture_level((deburr_golden*)golden, texture, level,
      (const uint8_t*)svGetArrayPtr(texels), (size_t)svSize(texels, 1), stride);
}

int deburr_dpi_texture_fills(void* golden, const svOpenArrayHandle lines, uint32_t* count) {
  return deburr_texture_fills((deburr_golden*)golden,
      (uint32_t*)svGetArrayPtr(lines), (size_t)svSize(lines, 1), count);
}

int deburr_dpi_morphological_edges(void* golden, const svOpenArrayHandle edges, uint32_t stride) {
  return deburr_morphological_edges((deburr_golden*)golden,
      (const uint8_t*)svGetArrayPtr(edges), (size_t)svSize(edges, 1), stride);
}

int deburr_dpi_geometric_vertices(void* golden, const svOpenArrayHandle words) {
  return deburr_geometric_vertices((deburr_golden*)golden,
      (const uint32_t*)svGetArrayPtr(words), (size_t)svSize(words, 1));
}

int deburr_dpi_geometric_edges(void* golden, const svOpenArrayHandle words) {
  return deburr_geometric_edges((deburr_golden*)golden,
      (const uint32_t*)svGetArrayPtr(words), (size_t)svSize(words, 1));
}

int deburr_dpi_geometric_facing(void* golden, uint32_t faces, const svOpenArrayHandle bits) {
  return deburr_geometric_facing((deburr_golden*)golden, faces,
      (const uint8_t*)svGetArrayPtr(bits), (size_t)svSize(bits, 1));
}

int deburr_dpi_geometric_classes(void* golden, const svOpenArrayHandle classes) {
  return deburr_geometric_classes((deburr_golden*)golden,
      (uint8_t*)svGetArrayPtr(classes), (size_t)svSize(classes, 1));
}

#ifdef __cplusplus
}
#endif

// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/morphological_engine.h"

#include <utility>

#include "rtl_model/morphological/datasheets.h"
#include "spec/morphological/check_build.h"

namespace deburr::rtl::morphological {
namespace {

// With storage = memory.
MemoryPortParameters port_of(const spec::morphological::Parameters& p) {
  MemoryPortParameters port;
  port.outstanding = 2 * static_cast<std::uint32_t>(p.memory_outstanding);
  return port;
}

}  // namespace

MorphologicalEngine::MorphologicalEngine(const sc_core::sc_module_name& name, ClockDomain& clock,
                                         const spec::morphological::Parameters& parameters)
    : Engine(name, clock, spec::morphological::kRegisters, control_layout()),
      parameters_(check_build(parameters)),
      parameter_store("parameter_store", control, parameters_),
      window("edge_window", parameters_),
      rows(parameters_),
      sequencer("slot_sequencer", clock, parameters_, probe_),
      luma("luma_unit", clock, parameters_),
      edges("edge_detector", clock, parameters_),
      extractor("run_extractor", clock, parameters_, window, rows),
      endpoint_predictor_h("endpoint_predictor_h", clock, parameters_, rows),
      endpoint_predictor_v("endpoint_predictor_v", clock, parameters_, window),
      line_unit_h("line_unit_h", clock, parameters_, spec::morphological::Axis::kHorizontal),
      line_unit_v("line_unit_v", clock, parameters_, spec::morphological::Axis::kVertical),
      area("area_unit", clock, parameters_),
      weights_loader(parameters_.area == spec::morphological::AreaSource::kLearned
                         ? std::make_unique<WeightsLoader>(control, area.weights_port().value())
                         : nullptr),
      diagonals(parameters_.diagonals
                    ? std::make_unique<DiagonalUnit>("diagonal_unit", clock, parameters_)
                    : nullptr),
      text_guard(parameters_.text_guard
                     ? std::make_unique<TextGuard>("text_guard", clock, parameters_)
                     : nullptr),
      pixel_store("pixel_store", clock, parameters_),
      blender("blender", clock, parameters_, probe_),
      sums_h_("sums_h", built_lanes(parameters_), sums_shape(parameters_)),
      sums_v_("sums_v", built_lanes(parameters_), sums_shape(parameters_)),
      lines_h_("lines_h", built_lanes(parameters_), line_shape(parameters_)),
      lines_v_("lines_v", built_lanes(parameters_), line_shape(parameters_)) {
  control.on_busy([this] { return !sequencer.idle(); });
  sequencer.pixels_in(pixels_in);
  sequencer.slots_out(slots_);
  sequencer.beats_out(beats_);
  luma.slots_in(slots_);
  luma.lumas_out(lumas_);
  edges.lumas_in(lumas_);
  edges.edges_out(edge_bits_);
  extractor.edges_in(edge_bits_);
  extractor.area_slots_out(area_slots_);
  extractor.fetches_out(fetches_);
  for (std::size_t lane = 0; lane < built_lanes_.lanes; ++lane) {
    endpoint_predictor_h.descriptors_in[lane](
        extractor.descriptors(spec::morphological::Axis::kHorizontal, lane));
    endpoint_predictor_v.descriptors_in[lane](
        extractor.descriptors(spec::morphological::Axis::kVertical, lane));
  }
  endpoint_predictor_h.sums_out.bind(sums_h_);
  endpoint_predictor_v.sums_out.bind(sums_v_);
  line_unit_h.sums_in.bind(sums_h_);
  line_unit_v.sums_in.bind(sums_v_);
  line_unit_h.lines_out.bind(lines_h_);
  line_unit_v.lines_out.bind(lines_v_);
  area.lines_h_in.bind(lines_h_);
  area.lines_v_in.bind(lines_v_);
  area.slots_in(area_slots_);
  area.weights_out(weights_);
  area.finished_out(finished_);
  extractor.finished_in(finished_);
  pixel_store.beats_in(beats_);
  pixel_store.fetches_in(fetches_);
  pixel_store.pixels_out(pixels_);
  blender.weights_in(weights_);
  blender.pixels_in(pixels_);
  blender.pixels_out(pixels_out);
  blender.frames_done_out(frames_done_);
  sequencer.frames_done_in(frames_done_);

  parameter_store.configuration_out(configuration_);
  sequencer.configuration_in(configuration_);
  luma.configuration_in(configuration_);
  edges.configuration_in(configuration_);
  extractor.configuration_in(configuration_);
  endpoint_predictor_h.configuration_in(configuration_);
  endpoint_predictor_v.configuration_in(configuration_);
  line_unit_h.configuration_in(configuration_);
  line_unit_v.configuration_in(configuration_);
  area.configuration_in(configuration_);
  pixel_store.configuration_in(configuration_);
  blender.configuration_in(configuration_);
  sequencer.first_beat_out(first_beat_);
  parameter_store.first_beat_in(first_beat_);
  parameter_store.enabled_out(enabled_);
  sequencer.enabled_in(enabled_);
  sequencer.latch_out(latch_);
  parameter_store.latch_in(latch_);
  parameter_store.latched_out(latched_);
  sequencer.latched_in(latched_);
  sequencer.frame_done_out(frame_done_);
  parameter_store.frame_done_in(frame_done_);
  sequencer.framing_out(framing_);
  parameter_store.framing_in(framing_);

  if (diagonals) {
    diagonals->configuration_in(configuration_);
    columns_ = std::make_unique<Link<DiagonalColumnsToken>>(
        "diagonal_columns", 2, diagonal_columns_shape(parameters_, built_lanes(parameters_)));
    (*extractor.columns_out)(*columns_);
    diagonals->columns_in(*columns_);
    (*area.diagonals_in)(diagonals->weights());
    control.show(spec::morphological::reg::kDiagonals, diagonals->diagonal_pixels);
  }
  if (text_guard) {
    text_guard->configuration_in(configuration_);
    guard_slots_ = std::make_unique<Link<GuardSlotToken>>("guard_slots", 2, built_lanes_);
    (*sequencer.guard_slots_out)(*guard_slots_);
    text_guard->slots_in(*guard_slots_);
    (*blender.guards_in)(text_guard->guards());
  }
  if (parameters_.storage == spec::morphological::Storage::kMemory) {
    const MemoryPortParameters port = port_of(parameters_);
    memory_port = std::make_unique<MemoryPort>("memory_port", clock, port);
    requests_ = std::make_unique<Link<MemoryRequest>>(
        "requests", 2, request_shape(port, 32, PixelStore::kTagBits));
    responses_ = std::make_unique<Link<MemoryResponse>>(
        "responses", 2, response_shape(port, 32, PixelStore::kTagBits));
    pixel_store.connect(*requests_, *responses_);
    memory_port->requests_in(*requests_);
    memory_port->responses_out(*responses_);
    uses(*memory_port);
    memory_error_ = std::make_unique<Pulse>("memory_error");
    (*pixel_store.memory_error_out)(*memory_error_);
    (*parameter_store.memory_error_in)(*memory_error_);
  }

  namespace reg = spec::morphological::reg;
  const std::pair<std::uint32_t, Counter*> shown[] = {
      {reg::kPixels, &blender.pixels},
      {reg::kEdgePixels, &edges.edge_pixels},
      {reg::kHorizontalRuns, &extractor.horizontal_runs},
      {reg::kVerticalRuns, &extractor.vertical_runs},
      {reg::kLongRuns, &extractor.long_runs},
      {reg::kZRuns, &extractor.z_runs},
      {reg::kBlendedPixels, &blender.blended_pixels},
      {reg::kBypassedPixels, &blender.bypassed_pixels},
      {reg::kFrameCycles, &sequencer.frame_cycles},
      {reg::kDescriptorStalls, &extractor.descriptor_stalls},
      {reg::kMemoryErrors, &pixel_store.memory_errors}};
  for (const auto& [offset, counter] : shown) control.show(offset, *counter);
  // Counted per axis; the registers show the sum.
  control.show_sum(reg::kExtendedRuns,
                   {&endpoint_predictor_h.extended_runs, &endpoint_predictor_v.extended_runs});
  control.show_sum(reg::kSteps, {&endpoint_predictor_h.steps, &endpoint_predictor_v.steps});
  control.show_sum(reg::kProbes, {&endpoint_predictor_h.probes, &endpoint_predictor_v.probes});
  control.show_sum(reg::kDivides, {&line_unit_h.divides, &line_unit_v.divides});
}

bool MorphologicalEngine::idle() const {
  return sequencer.idle() && sequencer.pixels_in.link().empty();
}

std::vector<Datasheet> MorphologicalEngine::datasheets() const {
  std::vector<Datasheet> sheets = morphological::datasheets(parameters_);
  if (memory_port)
    sheets.push_back(MemoryPort::datasheet(port_of(parameters_), PixelStore::kTagBits));
  return sheets;
}

spec::morphological::Work MorphologicalEngine::work() const {
  spec::morphological::Work work;
  work.pixels = blender.pixels.value();
  work.edge_pixels = edges.edge_pixels.value();
  work.horizontal_runs = extractor.horizontal_runs.value();
  work.vertical_runs = extractor.vertical_runs.value();
  work.long_runs = extractor.long_runs.value();
  work.z_runs = extractor.z_runs.value();
  work.extended_runs =
      endpoint_predictor_h.extended_runs.value() + endpoint_predictor_v.extended_runs.value();
  work.steps = endpoint_predictor_h.steps.value() + endpoint_predictor_v.steps.value();
  work.probes = endpoint_predictor_h.probes.value() + endpoint_predictor_v.probes.value();
  work.divides = line_unit_h.divides.value() + line_unit_v.divides.value();
  work.blended_pixels = blender.blended_pixels.value();
  work.bypassed_pixels = blender.bypassed_pixels.value();
  if (diagonals) work.diagonal_pixels = diagonals->diagonal_pixels.value();
  return work;
}

void MorphologicalEngine::observe_runs(
    std::function<void(const spec::morphological::RunDescriptor&)> observer) {
  extractor.observer = std::move(observer);
}

void MorphologicalEngine::observe_lines(
    std::function<void(const spec::morphological::LineDescriptor&)> observer) {
  area.observe_lines(std::move(observer));
}

}  // namespace deburr::rtl::morphological

// SPDX-License-Identifier: MIT
// Common part of the handles of engines that smooth frames: the input frame, and planes of the
// smoothed one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/c/handle.h"
#include "golden/c/parameter_texts.h"
#include "spec/depth_check.h"
#include "spec/error.h"

namespace deburr::golden::c {

using Rgba8 = std::array<std::uint8_t, 4>;

// A plane of the results: up to four bytes per pixel, in order.
struct Plane {
  std::string_view name;
  std::uint32_t pixel_bytes;
  bool detail;  // only with Detail::kEverything
};

struct FrameSize {
  std::uint32_t width = 0, height = 0;
};

struct FrameHandle : deburr_golden {
  static constexpr const char* kWanted = "an engine that smooths frames";

  virtual std::span<const Plane> planes() const = 0;
  // Size of the last smoothed frame; 0 without one.
  virtual FrameSize result_size() const = 0;
  virtual bool has_detail() const = 0;
  virtual Rgba8 plane_pixel(std::size_t plane, int x, int y) const = 0;
  virtual void keep_everything(bool on) = 0;
  // Called before a new frame: discards other inputs of the previous frame.
  virtual void begin_frame() {}
  // Smooths the input frame.
  virtual void process() = 0;

  void clear_frame() {
    width = height = 0;
    pixels.clear();
    depth.clear();
    has_depth = false;
  }
  std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * width + x; }

  // The input frame; rows without padding.
  std::uint32_t width = 0, height = 0;
  std::vector<Rgba8> pixels;
  std::vector<std::uint32_t> depth;
  bool has_depth = false;
};

// Throws ArgumentError if a depth is invalid.
void require_depths(const spec::DepthCheck& check, std::size_t width);
// Throws ArgumentError unless a frame was begun.
void require_frame(const FrameHandle& handle);

// Model of an engine. A changed parameter creates a new model, which replaces the old one only if
// it accepts the frame.
template <class Golden, class Parameters>
class FrameModel {
 public:
  // Calls work(golden) with a model of these parameters.
  template <class Work>
  void process(const Parameters& parameters, bool everything, Work&& work) {
    try {
      if (!model_ || stale_) {
        auto fresh = std::make_unique<Golden>(parameters,
                                              everything ? Detail::kEverything : Detail::kPixels);
        work(*fresh);
        model_ = std::move(fresh);
        stale_ = false;
        everything_ = everything;
        return;
      }
      work(*model_);
    } catch (const spec::ConfigError&) {
      throw;  // thrown before any change
    } catch (...) {
      model_.reset();
      throw;
    }
  }
  void mark_stale() { stale_ = true; }
  void drop() { model_.reset(); }
  const Golden* get() const { return model_.get(); }
  FrameSize size() const {
    if (!model_) return {};
    return {static_cast<std::uint32_t>(model_->width()),
            static_cast<std::uint32_t>(model_->height())};
  }
  bool everything() const { return model_ && everything_; }

 private:
  using Detail = typename Golden::Detail;
  std::unique_ptr<Golden> model_;
  bool stale_ = false;
  bool everything_ = false;
};

// Parameters and model of such an engine; inputs and results are in derived classes. The engine's
// check_build(parameters) rejects invalid parameters.
template <class Golden, class Parameters>
struct ModelHandle : FrameHandle {
  explicit ModelHandle(ParameterTexts<Parameters> of_engine) : texts(std::move(of_engine)) {}

  void set(std::string_view name, std::string_view text) override {
    texts.set(name, text);
    model.mark_stale();
  }
  std::string get(std::string_view name) const override { return texts.get(name); }
  void check() const override { check_build(texts.values()); }
  std::span<const std::string> parameter_names() const override { return texts.names(); }
  void reset() override {
    model.drop();
    clear_frame();
  }
  void set_error_lines(ErrorLines lines) override { error_lines = std::move(lines); }
  FrameSize result_size() const override { return model.size(); }
  bool has_detail() const override { return model.everything(); }
  void keep_everything(bool on) override {
    everything = on;
    model.mark_stale();
  }

  ParameterTexts<Parameters> texts;
  FrameModel<Golden, Parameters> model;
  bool everything = false;
  ErrorLines error_lines;
  std::vector<Counter> shown;
};

// Counts of an engine, named after their registers (spec/ENGINE/packets.h).
template <class Counts, class Registers, class Work>
std::vector<Counter> counters_of(const Counts& counts, const Registers& registers,
                                 const Work& work) {
  std::vector<Counter> all;
  for (const auto& count : counts) {
    for (const auto& info : registers) {
      if (info.offset != count.offset) continue;
      std::string name(info.name);
      for (char& letter : name)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
      all.push_back({std::move(name), work.*count.count});
    }
  }
  return all;
}

}  // namespace deburr::golden::c

// SPDX-License-Identifier: MIT
// The texture unit's part of the module.
#include <memory>
#include <utility>

#include "golden/c/texture_handle.h"
#include "golden/texture/sampling.h"
#include "python/bindings/arrays.h"
#include "python/bindings/frames.h"
#include "python/bindings/module.h"
#include "spec/texture/packets.h"

namespace deburr::golden::texture {

template <class Visit>
void record_fields(const Step& step, Visit& visit) {
  visit("s", step.s);
  visit("t", step.t);
}
template <class Visit>
void record_fields(const Footprint& footprint, Visit& visit) {
  visit("major", footprint.major);
  visit("d_max", footprint.d_max);
  visit("d_min", footprint.d_min);
  visit("area", footprint.area);
}
template <class Visit>
void record_fields(const LevelOfDetail& lod, Visit& visit) {
  visit("lb_d_max", lod.lb_d_max);
  visit("lb_d_min", lod.lb_d_min);
  visit("anisotropy", lod.anisotropy);
  visit("sampled", lod.sampled);
  visit("samples", lod.samples);
  visit("l", lod.l);
  visit("magnified", lod.magnified);
  visit("linear", lod.linear);
  visit("level", lod.level);
  visit("fraction", lod.fraction);
}
template <class Visit>
void record_fields(const FragmentAnalysis& fragment, Visit& visit) {
  visit("valid", fragment.valid);
  visit("saturated", fragment.saturated);
  visit("d_x", fragment.d_x);
  visit("d_y", fragment.d_y);
  visit("p_x", fragment.p_x);
  visit("p_y", fragment.p_y);
  visit("footprint", fragment.footprint);
  visit("axis", fragment.axis);
  visit("lod", fragment.lod);
}

}  // namespace deburr::golden::texture

namespace deburr::python {
namespace {

namespace c = golden::c;
using golden::texture::FragmentAnalysis;
using golden::texture::TextureGolden;
using spec::texture::Colour;
using spec::texture::Quad;

// Quads between two checks for Ctrl-C: some milliseconds.
constexpr std::size_t kQuadsAtATime = 4096;

class TextureUnit {
 public:
  TextureUnit(std::uint64_t memory, const py::dict& parameters) {
    handle_.remedy = "load() and TextureUnit(memory=...) make it larger";
    set_all(handle_.texts, parameters);
    c::resize_memory(handle_, memory);
    handle_.check();
  }

  // Runs work(handle); raises an error if another thread is in a call.
  template <class Work>
  auto turn(Work&& work) {
    const c::Turn turn(handle_);
    if (!turn)
      throw std::runtime_error(
          "the texture unit is in use by another thread: give each thread a unit of its own, or "
          "call in turn");
    return work(handle_);
  }

  // Sets all parameters, or none if one is rejected.
  void set(const py::dict& parameters) {
    turn([&](c::TextureHandle& h) {
      auto texts = h.texts;
      set_all(texts, parameters);
      check_build(texts.values());
      h.texts = std::move(texts);
      h.stale = true;
    });
  }
  py::dict parameters() {
    return turn([](c::TextureHandle& h) {
      py::dict values;
      for (const std::string& name : h.texts.names()) values[py::str(name)] = h.texts.get(name);
      return values;
    });
  }
  void set_fields(std::uint32_t texture, const py::dict& fields) {
    turn([&](c::TextureHandle& h) {
      const c::DescriptorWords before = h.words(texture);
      try {
        for (const auto& [name, value] : fields)
          c::set_field(h, texture, py::cast<std::string>(name), text_of(value));
      } catch (...) {
        h.put_words(texture, before);
        throw;
      }
    });
  }
  py::array filter(const py::object& given) {
    const py::array array = quads_of(given);
    const auto quads = elements<Quad>(array);
    return turn([&](c::TextureHandle& h) {
      std::vector<Colour> colours;
      colours.reserve(4 * quads.size());
      in_parts(
          quads,
          [&](std::span<const Quad> part) {
            TextureGolden& golden = h.model();
            for (const Quad& quad : part)
              for (const Colour& colour : golden.process(quad)) colours.push_back(colour);
          },
          [&] { h.model().clear_fills(); });
      return owned(std::move(colours));
    });
  }
  py::array analyse(const py::object& given) {
    const py::array array = quads_of(given);
    const auto quads = elements<Quad>(array);
    return turn([&](c::TextureHandle& h) {
      std::vector<FragmentAnalysis> all;
      all.reserve(4 * quads.size());
      in_parts(
          quads,
          [&](std::span<const Quad> part) {
            const TextureGolden& golden = h.model();
            for (const Quad& quad : part)
              for (int lane = 0; lane < 4; ++lane) all.push_back(golden.analyse(quad, lane));
          },
          [] {});
      return owned(std::move(all), {static_cast<py::ssize_t>(quads.size()), 4});
    });
  }
  py::array fills() {
    return turn([](c::TextureHandle& h) {
      return owned(h.golden ? std::vector<std::uint32_t>(h.golden->memory_lines())
                            : std::vector<std::uint32_t>{});
    });
  }
  Figures work() {
    return turn([](c::TextureHandle& h) {
      py::dict values;
      for (const c::Counter& counter : h.counters()) values[py::str(counter.name)] = counter.value;
      const golden::texture::TextureWork work =
          h.golden ? h.golden->work() : golden::texture::TextureWork{};
      values["by_samples"] =
          owned(std::vector<std::uint64_t>(work.by_samples.begin(), work.by_samples.end()));
      values["by_level"] =
          owned(std::vector<std::uint64_t>(work.by_level.begin(), work.by_level.end()));
      return figures(values);
    });
  }
  void write(std::uint64_t address, const py::object& given) {
    const py::array array = checked_list<std::uint8_t>(given, "bytes", "uint8 of (n,)");
    const auto bytes = elements<std::uint8_t>(array);
    turn([&](c::TextureHandle& h) {
      c::require_in_memory(h, address, bytes.size(), "bytes");
      std::copy(bytes.begin(), bytes.end(),
                h.memory.begin() + static_cast<std::ptrdiff_t>(address));
    });
  }
  py::array read(std::uint64_t address, std::uint64_t size) {
    return turn([&](c::TextureHandle& h) {
      c::require_in_memory(h, address, size, "bytes");
      const auto first = h.memory.begin() + static_cast<std::ptrdiff_t>(address);
      return owned(std::vector<std::uint8_t>(first, first + static_cast<std::ptrdiff_t>(size)));
    });
  }
  // Texels of a level as bytes, rows without gaps.
  void level(std::uint32_t texture, std::uint32_t level, const py::object& given) {
    const py::array array = checked_list<std::uint8_t>(given, "texels", "uint8 of (bytes,)");
    turn([&](c::TextureHandle& h) {
      c::put_level(h, texture, level, elements<std::uint8_t>(array), 0);
    });
  }
  // Register values of a texture's descriptor.
  py::tuple words(std::uint32_t texture) {
    return turn([&](c::TextureHandle& h) {
      py::list words;
      for (const std::uint32_t word : h.words(texture)) words.append(word);
      return py::tuple(words);
    });
  }
  py::dict describe(std::uint32_t texture) {
    return turn([&](c::TextureHandle& h) {
      const spec::texture::Descriptor d = c::descriptor_of(h.words(texture));
      py::dict values;
      values["width"] = d.width;
      values["height"] = d.height;
      values["levels"] = d.levels;
      const auto format = static_cast<std::size_t>(d.format);
      const bool known = format < spec::texture::kFormatBytes.size();
      values["texel_bytes"] = known ? spec::texture::kFormatBytes[format] : 0;
      values["block_bytes"] = known ? spec::texture::kFormatBlockBytes[format] : 0;
      py::list bases;
      for (const std::uint32_t base : d.base) bases.append(base);
      values["bases"] = py::tuple(bases);
      const char* const fault = golden::texture::descriptor_fault(d, h.texts.values().decode);
      values["fault"] = fault ? py::object(py::str(fault)) : py::object(py::none());
      return values;
    });
  }
  void fail_lines(const py::object& lines) {
    auto errors = error_lines(lines);
    turn([&](c::TextureHandle& h) { h.set_error_lines(std::move(errors)); });
  }

 private:
  static py::array quads_of(const py::object& given) {
    return checked_list<Quad>(given, "quads", "an array of QUAD of (n,)");
  }
  // Calls begin(), then do_part(quads) for each part in order with the GIL released; Ctrl-C ends it
  // between two parts.
  template <class Do, class Begin>
  static void in_parts(std::span<const Quad> quads, Do&& do_part, Begin&& begin) {
    begin();
    while (!quads.empty()) {
      const auto part = quads.first(std::min(quads.size(), kQuadsAtATime));
      {
        const py::gil_scoped_release others_run;
        do_part(part);
      }
      quads = quads.subspan(part.size());
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

  c::TextureHandle handle_;
};

}  // namespace

void add_texture(py::module_& module) {
  py::class_<TextureUnit>(module, "TextureUnit")
      .def(py::init<std::uint64_t, const py::dict&>())
      .def("set", &TextureUnit::set)
      .def("parameters", &TextureUnit::parameters)
      .def("set_fields", &TextureUnit::set_fields)
      .def("set_register",
           [](TextureUnit& unit, std::uint32_t texture, std::uint32_t offset, std::uint32_t word) {
             unit.turn([&](c::TextureHandle& h) { c::set_register(h, texture, offset, word); });
           })
      .def("place",
           [](TextureUnit& unit, std::uint32_t texture, std::uint64_t address) {
             return unit.turn([&](c::TextureHandle& h) { return c::place(h, texture, address); });
           })
      .def("words", &TextureUnit::words)
      .def("describe", &TextureUnit::describe)
      .def("level", &TextureUnit::level)
      .def("resize",
           [](TextureUnit& unit, std::uint64_t bytes) {
             unit.turn([&](c::TextureHandle& h) { c::resize_memory(h, bytes); });
           })
      .def("size",
           [](TextureUnit& unit) {
             return unit.turn([](c::TextureHandle& h) { return h.memory.size(); });
           })
      .def("write", &TextureUnit::write)
      .def("read", &TextureUnit::read)
      .def("filter", &TextureUnit::filter)
      .def("analyse", &TextureUnit::analyse)
      .def("fills", &TextureUnit::fills)
      .def("work", &TextureUnit::work)
      .def("fail_lines", &TextureUnit::fail_lines)
      .def("invalidate",
           [](TextureUnit& unit) {
             unit.turn([](c::TextureHandle& h) {
               if (h.golden) h.golden->invalidate_cache();
             });
           })
      .def("reset", [](TextureUnit& unit) { unit.turn([](c::TextureHandle& h) { h.reset(); }); });
  module.def("texture_parameters", [] { return parameter_rows(spec::texture::Parameters{}); });
  module.attr("QUAD") = dtype_of<Quad>();
  module.attr("COLOUR") = dtype_of<Colour>();
  py::list fields;
  for (const spec::RegisterInfo& info : spec::texture::kDescriptorRegisters) {
    for (const spec::Field& field : info.fields) {
      py::list codes;
      for (const std::string_view code : field.codes) codes.append(std::string(code));
      fields.append(
          py::make_tuple(std::string(field.name), std::string(field.meaning), py::tuple(codes)));
    }
  }
  module.attr("TEXTURE_FIELDS") = py::tuple(fields);
}

}  // namespace deburr::python

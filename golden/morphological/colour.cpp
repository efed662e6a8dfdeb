// SPDX-License-Identifier: MIT
#include "golden/morphological/colour.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "golden/morphological/bypass.h"

namespace deburr::golden::morphological {
namespace {

using spec::morphological::LocalContrast;
using spec::morphological::Rgba8;

using Byte = std::uint8_t;

Byte difference(Byte a, Byte b) { return static_cast<Byte>(std::max(a, b) - std::min(a, b)); }
Byte largest(Byte a, Byte b) { return std::max(a, b); }

// A row of pixels by channel, so that the loops vectorise. `open` is 255 where a pixel may have
// edges.
struct ColourRow {
  std::array<std::vector<Byte>, 3> channel;
  std::vector<Byte> open;

  explicit ColourRow(int width) : open(static_cast<std::size_t>(width), 255) {
    for (auto& c : channel) c.resize(static_cast<std::size_t>(width));
  }
  void read(const Rgba8* pixels, bool masked) {
    Byte *r = channel[0].data(), *g = channel[1].data(), *b = channel[2].data();
    for (std::size_t x = 0; x < open.size(); ++x) {
      r[x] = pixels[x][0];
      g[x] = pixels[x][1];
      b[x] = pixels[x][2];
    }
    if (!masked) return;
    for (std::size_t x = 0; x < open.size(); ++x) open[x] = is_marked(pixels[x]) ? 0 : 255;
  }
};

// Steps between pixels p[x] and q[x], in codes.
void steps(const ColourRow& p, std::size_t p0, const ColourRow& q, std::size_t count,
           Byte* result) {
  const Byte *pr = p.channel[0].data() + p0, *pg = p.channel[1].data() + p0,
             *pb = p.channel[2].data() + p0, *po = p.open.data() + p0;
  const Byte *qr = q.channel[0].data(), *qg = q.channel[1].data(), *qb = q.channel[2].data(),
             *qo = q.open.data();
  for (std::size_t x = 0; x < count; ++x) {
    const Byte step = largest(largest(difference(pr[x], qr[x]), difference(pg[x], qg[x])),
                              difference(pb[x], qb[x]));
    result[x] = static_cast<Byte>(step & po[x] & qo[x]);
  }
}

// Steps of the current row, the row above and the row below. at(x) of a row: x from -1 to width.
class ByteSteps {
 public:
  ByteSteps(const ImageView& image, bool masked)
      : image_(image), masked_(masked), above_(image.width), own_(image.width) {
    for (auto* rows : {&across_, &down_})
      for (auto& row : *rows) row.assign(static_cast<std::size_t>(image.width) + 2, 0);
    fill(0);
  }
  // Moves to row y; call with y = 0, 1, 2, ... in order.
  void advance_to(int y) {
    y_ = y;
    fill(y + 1);
  }
  const Byte* across(int dy) const { return row(across_, dy); }
  const Byte* down(int dy) const { return row(down_, dy); }

 private:
  using Rows = std::array<std::vector<Byte>, 3>;
  static std::size_t slot(int y) { return static_cast<std::size_t>(y + 3) % 3; }
  const Byte* row(const Rows& rows, int dy) const { return rows[slot(y_ + dy)].data() + 1; }
  void fill(int y) {
    auto& across = across_[slot(y)];
    auto& down = down_[slot(y)];
    if (y >= image_.height) {  // its steps across are never read
      std::fill(down.begin(), down.end(), Byte{0});
      return;
    }
    std::swap(above_, own_);
    own_.read(image_.row(y), masked_);
    const auto width = static_cast<std::size_t>(image_.width);
    steps(own_, 1, own_, width - 1, across.data() + 2);
    if (y > 0) steps(own_, 0, above_, width, down.data() + 1);
  }

  const ImageView& image_;
  bool masked_;
  int y_ = 0;
  ColourRow above_, own_;
  Rows across_, down_;
};

// Edge flags of a row: own[x] is at least `least`, and above half of around(x), or equal to half
// with `or_equal`.
template <class Around>
void decide(const Byte* own, int width, Byte least, bool or_equal, const Around& around,
            Byte* flags) {
  const Byte odd = or_equal ? 1 : 0;
  for (std::ptrdiff_t x = 0; x < width; ++x) {
    // 2 c > m is c >= (m >> 1) + 1; 2 c >= m is c >= (m + 1) >> 1. Neither sum exceeds a byte.
    const Byte m = around(x);
    const Byte half = static_cast<Byte>((m >> 1) + (odd != 0 ? (m & 1) : 1));
    flags[x] = static_cast<Byte>((own[x] >= least) & (own[x] >= half));
  }
}

}  // namespace

EdgePlanes colour_edges(const spec::morphological::Parameters& p, const ImageView& image) {
  const int width = image.width;
  EdgePlanes edges{BitPlane(width, image.height), BitPlane(width, image.height)};
  std::vector<Byte> flags(static_cast<std::size_t>(edges.left.words()) * 64);
  // The smallest step in codes with 65536 c >= T. Above 255 no step is an edge.
  const int least_step = (p.threshold + 65535) >> 16;
  if (least_step > 255) return edges;
  const Byte least = static_cast<Byte>(least_step);
  ByteSteps steps(image, p.bypass == spec::morphological::Bypass::kMasked);
  for (int y = 0; y < image.height; ++y) {
    steps.advance_to(y);
    const Byte *a = steps.across(0), *d = steps.down(0), *a_above = steps.across(-1),
               *d_above = steps.down(-1), *d_below = steps.down(1);
    const auto find = [&](BitPlane& plane, const Byte* own, const auto& around) {
      decide(own, width, least, p.local_contrast == LocalContrast::kSmaa, around, flags.data());
      for (std::ptrdiff_t i = 0; i < plane.words(); ++i)
        plane.row(y)[i] = packed_flags(flags.data() + 64 * i);
    };
    switch (p.local_contrast) {
      case LocalContrast::kOff: {
        const auto nothing = [](std::ptrdiff_t) { return Byte{0}; };
        find(edges.left, a, nothing);
        find(edges.top, d, nothing);
        break;
      }
      case LocalContrast::kSymmetric:
        find(edges.left, a, [&](std::ptrdiff_t x) {
          return largest(largest(a[x + 1], a[x - 1]),
                         std::min(largest(d[x], d_below[x]), largest(d[x - 1], d_below[x - 1])));
        });
        find(edges.top, d, [&](std::ptrdiff_t x) {
          return largest(largest(d_below[x], d_above[x]),
                         std::min(largest(a[x], a[x + 1]), largest(a_above[x], a_above[x + 1])));
        });
        break;
      case LocalContrast::kPaper:
      case LocalContrast::kSmaa: {
        const auto of_pixel = [&](std::ptrdiff_t x) {
          return largest(largest(largest(d[x], d_below[x]), largest(a[x], a[x + 1])),
                         largest(d_above[x], a[x - 1]));
        };
        find(edges.left, a, of_pixel);
        find(edges.top, d, of_pixel);
        break;
      }
    }
  }
  return edges;
}

}  // namespace deburr::golden::morphological

// SPDX-License-Identifier: MIT
/// \file
/// How far a picture is from a reference.
///
/// The reference holds linear values, each the average of the radiance over the area of its pixel:
/// a box filter of one pixel, exact or converged. A method that filters wider is measured against
/// the same picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// The laboratory: this library against other systems, measured.
namespace quality {

/// A picture that lives elsewhere: linear RGB, interleaved, row by row.
struct PictureView {
  std::size_t width = 0;   ///< pixels, at least 1
  std::size_t height = 0;  ///< pixels, at least 1
  std::span<const float> pixels;
};

/// The blocks in which errors are looked for are those of the frequency image. A picture whose size
/// is no multiple of 8 has smaller blocks on its right and lower side.
inline constexpr std::size_t block_size = 8;

/// Side of the window of ssim(), in pixels.
inline constexpr std::size_t ssim_window = 11;

/// What measure() finds. All numbers are over the three channels together.
struct Metrics {
  double rmse = 0;              ///< see rmse()
  double psnr = 0;              ///< see psnr(); dB
  double relative_mse = 0;      ///< see relative_mse()
  double ssim = 0;              ///< see ssim()
  double worst_block_rmse = 0;  ///< the greatest of block_rmse()
  double missed_blocks = 0;     ///< see missed_blocks()
  double seam = 0;              ///< see seam_visibility()
  double bad_values = 0;        ///< values of the picture that were not finite, taken for 0
  double relmse = 0;            ///< see relmse()
  double mean_ratio = 0;        ///< see mean_ratio()
  double border_step = 0;       ///< see border_step()
  double negative_share = 0;    ///< see negative_share()
};

// All of these throw std::invalid_argument naming the sizes when the two pictures differ in size,
// have no pixel, or do not hold three values per pixel.

/// Root of the mean squared difference of linear values, >= 0.
[[nodiscard]] double rmse(const PictureView& picture, const PictureView& reference);

/// Peak signal-to-noise ratio, in dB, of display-encoded values: linear values are clamped to 0..1,
/// encoded by the transfer function of sRGB (IEC 61966-2-1), scaled to 0..255 and not rounded; the
/// peak is 255. Infinite when these are equal.
[[nodiscard]] double psnr(const PictureView& picture, const PictureView& reference);

/// Mean of (v - r)^2 / (r + 0.01)^2 over linear values v and r of picture and reference: an error
/// in the shade counts as much as in the light. >= 0.
[[nodiscard]] double relative_mse(const PictureView& picture, const PictureView& reference);

/// Mean structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004) of the luma (BT.601) of
/// display-encoded values as in psnr(): window of 11 x 11 pixels with Gaussian weights of sigma 1.5
/// pixels, K1 = 0.01, K2 = 0.03, L = 255, over all windows that lie inside. -1..1, 1 when equal.
/// \throws std::invalid_argument also when the picture is smaller than a window.
[[nodiscard]] double ssim(const PictureView& picture, const PictureView& reference);

/// rmse() of each block, row by row.
[[nodiscard]] std::vector<double> block_rmse(const PictureView& picture,
                                             const PictureView& reference);

/// Number of blocks that a method left too early: their block_rmse() is over five times the rmse()
/// of the picture, and they got fewer samples per pixel than the picture has on average.
/// \param samples  taken in each pixel, row by row
/// \throws std::invalid_argument also when there is not one count per pixel.
[[nodiscard]] std::size_t missed_blocks(const PictureView& picture, const PictureView& reference,
                                        std::span<const std::uint32_t> samples);

/// How visible the borders of blocks are in the error e = picture - reference: the mean of
/// |e(p) - e(q)| over neighbouring pixels p and q on both sides of a border between two blocks,
/// divided by the mean over neighbours within a block; both horizontally and vertically. 1: no
/// seam. Below 1: errors agree across borders better than elsewhere. 1 as well when the error is
/// the same everywhere or there is no border; infinite when it changes at borders only.
[[nodiscard]] double seam_visibility(const PictureView& picture, const PictureView& reference);

/// Mean of (v - r)^2 / (r^2 + 0.01): the relative error that denoisers are compared by (Rousselle,
/// Knaus and Zwicker 2011). >= 0.
[[nodiscard]] double relmse(const PictureView& picture, const PictureView& reference);

/// The mean of the picture's values over that of the reference: below 1 light is lost. 1 when both
/// are 0.
[[nodiscard]] double mean_ratio(const PictureView& picture, const PictureView& reference);

/// How visible the borders of blocks are in the picture itself: as seam_visibility(), with
/// display-encoded values as in psnr() in place of errors. 1 in a gradient.
[[nodiscard]] double border_step(const PictureView& picture);

/// The share of values below 0.
[[nodiscard]] double negative_share(const PictureView& picture);

/// All of them.
/// \param samples  taken in each pixel, row by row
/// \throws std::invalid_argument as the functions above, and when the reference has a value that is
///         not finite.
[[nodiscard]] Metrics measure(const PictureView& picture, const PictureView& reference,
                              std::span<const std::uint32_t> samples);

}  // namespace quality

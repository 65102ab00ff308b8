// The threshold of a bed whose packing is a matter of chance: what the brackets of several seeds say of it together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace bedload {

/// Where one packing began to move.
struct SeedBracket {
  std::uint64_t seed = 0;
  double lower = 0;                                         // theta of the last hold that came to rest; 0: none did [-]
  double upper = std::numeric_limits<double>::infinity();   // of the first that stayed mobile; infinity: none did [-]
};

/// What is known of theta_50. `none`: nothing, since there are no bounds, or bounds from one side only that contradict each
/// other (beds at rest where others move), which fit no width.
enum class ThresholdStatus { bracketed, only_upper_bound, only_lower_bound, none };

/// A log-normal distribution of the thresholds of packings. Values that the brackets do not give are nan.
struct ThresholdFit {
  ThresholdStatus status = ThresholdStatus::none;
  double theta_50 = std::numeric_limits<double>::quiet_NaN();   // median: half of all packings move below it [-]
  double theta_16 = std::numeric_limits<double>::quiet_NaN();   // one deviation of the logarithm below it, where
  double theta_84 = std::numeric_limits<double>::quiet_NaN();   // the width is resolved, and above [-]
  bool width_resolved = false;                                  // else the width is below the bracket
  /// All that theta_50 may be by the fit [-]: itself if the width is resolved; the interval that all brackets have in common,
  /// if not; 0 to the highest upper bound, or the lowest lower bound to infinity, where there are only such.
  double lower = 0, upper = std::numeric_limits<double>::infinity();
};

/// Where theta_50 lies, the seeds being the sample. How often it does so was measured: docs/decisions/threshold_fit.md.
struct ThresholdInterval {
  double lower = 0, upper = std::numeric_limits<double>::infinity();   // 0 and infinity: open [-]
  double confidence = 0;   // 0.95; with fewer than six seeds what they allow, 1 - 2^(1 - seeds)
};

/// Maximum likelihood with ln theta normal and known to lie in the brackets (docs/decisions/threshold_fit.md). Open brackets
/// (0 to infinity) say nothing and are left out. The result does not depend on the order of the brackets.
/// Throws Error `numerical` for bounds that are negative, not numbers, or not in order; `internal` for a seed given twice.
ThresholdFit fit_threshold(std::span<const SeedBracket>);

/// The interval of theta_50 at 95 %. With a width and six seeds or more from 2000 resamples of them, drawn from
/// RandomStream(0, Stream::resampling, resample), member k being bracket floor(n u_k) of those in order of the seeds, u_k
/// uniform in (0, 1). A resample gives what its fit allows, `lower` to `upper`; the interval reaches from the quantile of
/// the lower ends to that of the upper ones, so that resamples which know theta_50 from one side open the other.
/// Without a width, or with fewer seeds, from the ranks of the bounds (sign test), whatever the distribution.
/// Order and errors as fit_threshold.
ThresholdInterval interval_of_threshold(std::span<const SeedBracket>);

/// Whether seeds 1..k suffice: the interval has its 95 % and half its width is at most `wanted` times theta_50, or k has
/// reached `most`. Judged after every `batch` seeds only, so that it does not matter which case of a batch ends first.
/// Throws Error `study_invalid` unless batch and most are at least 1 and wanted is positive, else as fit_threshold.
bool enough_seeds(std::span<const SeedBracket> first_k, int batch, double wanted_relative_interval, int most);

/// The share of resamples to leave out at each end for an interval of 95 % from n >= 2 seeds. Resamples of few spread less
/// than they should; this many leave as wide an interval as Student's t: Phi(-t sqrt(n/(n - 1))), t at 97.5 % with n - 1
/// degrees of freedom. Hesterberg, "What teachers should know about the bootstrap", Am. Statistician 69 (2015) 371.
double share_beyond_each_end(std::size_t seeds);

}   // namespace bedload

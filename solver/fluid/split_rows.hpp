// Rows kept as their even entries and their odd entries, and the way there and back.
#pragma once

namespace bedload {

/// even = scale x entries 0, 2, ..., odd = scale x entries 1, 3, ... of a row of n.
template <class Number>
void split_row(const Number* __restrict row, Number scale, int n, float* __restrict even,
               float* __restrict odd) noexcept {
  for (int m = 0; m < n / 2; ++m) {
    even[m] = static_cast<float>(row[2 * m] * scale);
    odd[m] = static_cast<float>(row[2 * m + 1] * scale);
  }
  if (n % 2) even[n / 2] = static_cast<float>(row[n - 1] * scale);
}

/// The same, added to what is there.
inline void add_split_row(const float* __restrict row, float scale, int n, float* __restrict even,
                          float* __restrict odd) noexcept {
  for (int m = 0; m < n / 2; ++m) {
    even[m] += scale * row[2 * m];
    odd[m] += scale * row[2 * m + 1];
  }
  if (n % 2) even[n / 2] += scale * row[n - 1];
}

/// The row again.
template <class Number>
void join_row(const float* __restrict even, const float* __restrict odd, int n, Number* __restrict row) noexcept {
  for (int m = 0; m < n / 2; ++m) {
    row[2 * m] = even[m];
    row[2 * m + 1] = odd[m];
  }
  if (n % 2) row[n - 1] = even[n / 2];
}

}   // namespace bedload

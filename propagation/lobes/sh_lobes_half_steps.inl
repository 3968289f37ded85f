// A part of sh_lobes_kernels.inl, in its namespace.
//
// Steps of half a cell do on a coarse grid what a pass does on the fine one: between coarse cells light changes evenly
// (Lax and Wendroff 1960), so that what is half a cell wide at a face is 3/8 of one cell's light and 1/8 of
// the next one's. Mean and spread of a step are those of the fine grid then, along the axes and between them.

/// Light of a cell that is next to the face that it travels to. Limited to what a whole step passes: six faces never
/// pass more than there is. @return where a whole step passes anything.
template <class Order, int kAxis, int kSign>
VOLGI_INLINE Mask nearer_half(const Row* cell, const Row* across, Mask open, Row* out) {
  const Row own_share = open ? Row{} + 0.375f : Row{} + 0.5f, share_across = select(open, Row{} + 0.125f);
  for (int k = 0; k < Order::kCoefficients; ++k) out[k] = own_share * cell[k] + share_across * across[k];
  const Row limit = passed<Order, kAxis, kSign>(cell), now = passed<Order, kAxis, kSign>(out);
  const Mask some = now > 0.0f;
  const Row limited = limit < now ? limit : now;
  const Row factor = select(some, limited / (some ? now : Row{} + 1.0f));
  for (int k = 0; k < Order::kCoefficients; ++k) out[k] *= factor;
  return limit > 0.0f;
}

/// Adds what comes in across the two faces of an axis, and what stays of what moves along it: that crosses a face of
/// the fine grid, too.
template <class Order, int kAxis, class M>
VOLGI_INLINE void exchange_halves(const Row* below, const Row* own, const Row* above, M open_below, M open_above,
                                  Row* out) {
  constexpr int n = Order::kCoefficients;
  Row up[n], down[n];
  nearer_half<Order, kAxis, 1>(below, own, open_below, up);
  nearer_half<Order, kAxis, -1>(above, own, open_above, down);
  Order::template add_both<kAxis>(up, open_below, down, open_above, out);
  const M some_up = nearer_half<Order, kAxis, 1>(own, above, open_above, up);
  const M some_down = nearer_half<Order, kAxis, -1>(own, below, open_below, down);
  for (int k = 0; k < n; ++k) {
    up[k] = own[k] - up[k];
    down[k] = own[k] - down[k];
  }
  Order::template add_open<kAxis>(up, Order::template power<kAxis, 1>(up), some_up, down,
                                  Order::template power<kAxis, -1>(down), some_down, out);
}

template <class Order, class Open>
VOLGI_INLINE void gather_half_row(const Around& a, int at, const Open& open, Row* out) {
  constexpr int n = Order::kCoefficients;
  Row own[n], below[n], above[n];
  for (int k = 0; k < n; ++k) {
    own[k] = load(a.own + at + k * kStride);
    out[k] = Row{};
  }
  for (int k = 0; k < n; ++k) {
    below[k] = load(below_x(a.own, a.beside[0], at) + k * kStride);
    above[k] = load(above_x(a.own, a.beside[1], at) + k * kStride);
  }
  exchange_halves<Order, 0>(below, own, above, open(0), open(1), out);
  for (int k = 0; k < n; ++k) {
    below[k] = below_y(a.own + k * kStride, a.beside[2] + k * kStride, at);
    above[k] = above_y(a.own + k * kStride, a.beside[3] + k * kStride, at);
  }
  exchange_halves<Order, 1>(below, own, above, open(2), open(3), out);
  for (int k = 0; k < n; ++k) {
    below[k] = below_z(own[k], load(a.beside[4] + at + k * kStride));
    above[k] = above_z(own[k], load(a.beside[5] + at + k * kStride));
  }
  exchange_halves<Order, 2>(below, own, above, open(4), open(5), out);
  const Mask lit = out[0] > 0.0f;  // never negative but for rounding
  for (int k = 0; k < n; ++k) out[k] = select(lit, out[k]);
}

template <class Order>
void gather_half(const float* own, const float* const beside[6], const std::uint64_t* closed, float* out) {
  for (int band = 0; band < kLobeBands; ++band) {
    const Around around = of_band(own, beside, band);
    for (int at = 0; at < kLobeLeafCells; at += kWidth) {
      Row l[Order::kCoefficients];
      gather_half_row<Order>(
          around, at, [=](int face) { return open_mask(closed, at, face); }, l);
      for (int k = 0; k < Order::kCoefficients; ++k) store(out + lobe_block(k, band) + at, l[k]);
    }
  }
}

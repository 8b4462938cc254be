// What bake points see of each other, as BakeLinks; after lamp_words.glsl and the tables.
uint first_link(uint point) {
  uint stand_in = points[point].stand_in;
  return (stand_in == kNone ? point : stand_in) * aim.links_a_point;
}

// The open point that light comes from; above kNone: none does; kNone: the link does not count.
uint find_sender(uint link) {
  if (link < kClosed || link == kNone) return link;
  if (link > kNone) return 0xffffffffu;
  uint stand_in = points[link - kClosed].stand_in;
  return stand_in == kNone ? 0xffffffffu : stand_in;
}

bool is_lit(uint point) { return (lit[point / 32u] >> (point % 32u) & 1u) != 0u; }

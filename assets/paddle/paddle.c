#include "paddle.h"

#include <math.h>
#include <string.h>

enum { MAGIC = 0x4C, VERSION = 1, JOINTS = 1, CRC_AT = 60 };
enum { POWERED = 1, HAND = 2, CALIBRATED = 4, FAULT = 8, CUT = 16 };

// Vendor page 0xFF4C, usage 1: 64 bytes in, out and as a feature, no ids.
const uint8_t paddle_descriptor[PADDLE_DESCRIPTOR] = {
    0x06, 0x4C, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95,
    0x40, 0x09, 0x02, 0x81, 0x02, 0x09, 0x03, 0x91, 0x02, 0x09, 0x04, 0xB1, 0x02, 0xC0};

// The parts of README.md: 2048 lines on the motor's shaft, a capstan of 1:12, a motor of 0.023 N
// m/A and 2.4 ohm on 12 V.
const PaddleBuild paddle_build = {.counts = 4 * 2048 * 12 / 6.2831853f,
                                  .lower = -0.7f,
                                  .upper = 0.7f,
                                  .peak = 12 * 0.023f * 12 / 2.4f,
                                  .limit = 0.8f,
                                  .lasting = 0.3f,
                                  .warming = 10};

// Little-endian, as the board and this protocol are.
static uint32_t get_u32(const uint8_t* at) {
  uint32_t value;
  memcpy(&value, at, sizeof value);
  return value;
}
static float get_f32(const uint8_t* at) {
  float value;
  memcpy(&value, at, sizeof value);
  return value;
}
static void put(uint8_t* at, const void* value, uint32_t size) { memcpy(at, value, size); }

static uint32_t crc32_of(const uint8_t* bytes, uint32_t size) {
  uint32_t crc = 0xFFFFFFFFu;
  for (uint32_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0);
  }
  return ~crc;
}

static void head(uint8_t report[PADDLE_REPORT], uint8_t fourth) {
  memset(report, 0, PADDLE_REPORT);
  report[0] = MAGIC;
  report[1] = VERSION;
  report[2] = JOINTS;
  report[3] = fourth;
}

static void seal(uint8_t report[PADDLE_REPORT]) {
  const uint32_t crc = crc32_of(report, CRC_AT);
  put(report + CRC_AT, &crc, sizeof crc);
}

void paddle_begin(Paddle* paddle, const PaddleBuild* build, uint64_t now) {
  memset(paddle, 0, sizeof *paddle);
  paddle->build = *build;
  paddle->part = 1;
  paddle->fed = paddle->ticked = now;
}

void paddle_turn(Paddle* paddle, uint8_t pins) {
  // By the pins before and now: a step up, a step down, none, or 2 for two at once.
  static const int8_t steps[16] = {0, 1, -1, 2, -1, 0, 2, 1, 1, 2, 0, -1, 2, -1, 1, 0};
  const int8_t step = steps[(paddle->pins & 3) << 2 | (pins & 3)];
  for (int line = 0; line < 2; ++line) {
    const bool changed = (paddle->pins ^ pins) >> line & 1;
    if (changed) paddle->edges[line] = paddle->edges[line] + 1;
  }
  paddle->pins = pins & 3;
  if (step == 2) {
    paddle->skipped = paddle->skipped + 1;
  } else {
    paddle->count = paddle->count + step;
  }
}

void paddle_inputs(Paddle* paddle, bool at_lower_end, bool hand, bool driver_fault) {
  if (at_lower_end && !paddle->homed) {
    paddle->homed = true;
    paddle->home = paddle->count;
    paddle->skipped_known = paddle->skipped;
  }
  paddle->hand = hand;
  paddle->driver_fault = driver_fault;
}

float paddle_position(const Paddle* paddle) {
  return paddle->build.lower + (float)(paddle->count - paddle->home) / paddle->build.counts;
}

// It is not where it believes to be once it has skipped a step, or lost a line of its encoder.
static bool faulty(const Paddle* paddle) {
  return paddle->driver_fault || (paddle->homed && paddle->skipped != paddle->skipped_known) ||
         paddle->still >= 2 * PADDLE_STILL_US;
}

static bool usable(const uint8_t* report) {
  if (report[0] != MAGIC || report[1] != VERSION || report[2] != JOINTS || report[3] > 1) {
    return false;
  }
  for (int i = 0; i < 6; ++i) {
    if (!isfinite(get_f32(report + 16 + 4 * i))) return false;
  }
  return get_u32(report + CRC_AT) == crc32_of(report, CRC_AT);
}

bool paddle_command(Paddle* paddle, const uint8_t report[PADDLE_REPORT], uint64_t now) {
  if (!usable(report)) return false;
  const uint32_t sequence = get_u32(report + 4);
  const bool push = report[3] == 1;
  // After a restart or a cut it waits for a session to begin, and that is without torque.
  if (push && (!paddle->addressed || (int32_t)(sequence - paddle->command) <= 0)) return false;
  paddle->addressed = true;
  paddle->command = sequence;
  paddle->fed = now;
  paddle->cut = false;
  paddle->pushing = push;
  paddle->torque = push ? get_f32(report + 16) : 0;
  return true;
}

void paddle_reading(Paddle* paddle, uint8_t report[PADDLE_REPORT], uint64_t now) {
  head(report, (uint8_t)((paddle->homed ? POWERED | CALIBRATED : 0) | (paddle->hand ? HAND : 0) |
                         (faulty(paddle) ? FAULT : 0) | (paddle->cut ? CUT : 0)));
  const float x = paddle_position(paddle);
  ++paddle->sequence;
  put(report + 4, &paddle->sequence, 4);
  put(report + 8, &now, 8);
  put(report + 16, &x, 4);
  put(report + 40, &paddle->command, 4);
  seal(report);
}

void paddle_feature(const Paddle* paddle, uint8_t report[PADDLE_REPORT]) {
  const PaddleBuild* build = &paddle->build;
  head(report, 1);
  const uint16_t rate = 1000000 / PADDLE_PERIOD_US, watchdog = PADDLE_WATCHDOG_US / 1000;
  const int16_t lower = (int16_t)lroundf(1000 * build->lower);
  const int16_t upper = (int16_t)lroundf(1000 * build->upper);
  const float resolution = 1 / build->counts;
  const uint16_t limit = (uint16_t)lroundf(1000 * build->limit);
  put(report + 4, &rate, 2);
  put(report + 6, &watchdog, 2);
  put(report + 8, &lower, 2);
  put(report + 10, &upper, 2);
  put(report + 32, &resolution, 4);
  put(report + 36, &limit, 2);
  put(report + 48, "paddle", 6);
  seal(report);
}

// What part of the torque is left by how long it did not move. A paddle that is held still moves as
// its torque fades, and has it back; one without its encoder, or without one of the lines, of which
// the other alone counts up and down, does not. That ends once both have changed.
static float part_left(Paddle* paddle, uint32_t passed, float torque) {
  const float least = 0.05f * paddle->build.limit, fades_in = 500000;  // [N m, us]
  uint32_t* known = paddle->edges_known;
  if (paddle->edges[0] != known[0] && paddle->edges[1] != known[1]) {
    for (int line = 0; line < 2; ++line) known[line] = paddle->edges[line];
    paddle->still = 0;
  } else if (fabsf(torque) > least || paddle->still > PADDLE_STILL_US) {
    paddle->still += passed < PADDLE_STILL_US ? passed : PADDLE_STILL_US;
    if (paddle->still > 2 * PADDLE_STILL_US) paddle->still = 2 * PADDLE_STILL_US;
  }
  const float left = 2 - (float)paddle->still / PADDLE_STILL_US;
  const float grown = paddle->part + (float)passed / fades_in;
  paddle->part = fmaxf(fminf(fminf(left, grown), 1), 0);
  return paddle->part;
}

float paddle_drive(Paddle* paddle, uint64_t now) {
  const PaddleBuild* build = &paddle->build;
  const uint64_t passed = now - paddle->ticked;  // [us]
  const float dt = 1e-6f * (float)passed;
  paddle->ticked = now;
  if (paddle->pushing && now > paddle->fed + PADDLE_WATCHDOG_US) {
    paddle->pushing = false;
    paddle->cut = true;
    paddle->addressed = false;
  }
  const float x = paddle_position(paddle);
  const float beyond = 0.05f;  // of its ends, as play and cables allow [rad]
  const bool within = x > build->lower - beyond && x < build->upper + beyond;
  float torque = 0;
  if (paddle->pushing && paddle->homed && paddle->hand && !faulty(paddle) && within) {
    // A winding that is as warm as it may be gets no more than it bears for hours.
    const float most = paddle->heat < 1 ? build->limit : build->lasting;
    torque = fminf(fmaxf(paddle->torque, -most), most);
  }
  torque *= part_left(paddle, (uint32_t)(passed < 1000000 ? passed : 1000000), torque);
  const float warmth = torque / build->lasting;
  paddle->heat += (warmth * warmth - paddle->heat) * fminf(dt / build->warming, 1);
  return fminf(fmaxf(torque / build->peak, -1), 1);
}

// The firmware of a paddle with one joint, without its board: what comes over USB, what the encoder
// and the switches say, and what the motor gets. Speaks Limpid's open protocol, version 1
// (devices/hid/raw_protocol.h). Plain C without memory of its own; the same source runs
// on the board and in Limpid's tests.
//
// Times are microseconds since it was switched on. Nothing here may be called from two places at
// once, but for paddle_turn(), which only the encoder calls.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  PADDLE_REPORT = 64,          // bytes of each report, without an id
  PADDLE_DESCRIPTOR = 29,      // bytes of the report descriptor
  PADDLE_PERIOD_US = 1000,     // between two readings
  PADDLE_WATCHDOG_US = 10000,  // without a command, until the torque is cut
  PADDLE_STILL_US = 300000  // of torque without motion, until it fades; at twice of it it is gone
};
extern const uint8_t paddle_descriptor[PADDLE_DESCRIPTOR];

// What was built; see README.md.
typedef struct {
  float counts;        // of the encoder, per radian of the paddle
  float lower, upper;  // ends of its way [rad]; its switch is at the lower one
  float peak;          // torque at the paddle with the motor at full voltage, at rest [N m]
  float limit;         // most that is given [N m]
  float lasting;       // that the motor bears for hours [N m]
  float warming;       // time constant of its winding [s]
} PaddleBuild;
extern const PaddleBuild paddle_build;

typedef struct {
  PaddleBuild build;
  // Of the encoder.
  volatile int32_t count;
  volatile uint32_t skipped;   // steps that it was too fast for
  volatile uint32_t edges[2];  // changes of A, of B
  uint8_t pins;
  // Of the switches and the driver.
  bool homed, hand, driver_fault;
  int32_t home;  // count at the lower end
  uint32_t skipped_known;
  // Of the computer.
  bool addressed;  // a session has begun
  bool pushing, cut;
  uint32_t command, sequence;  // newest of each
  uint64_t fed;                // when the newest usable command came [us]
  float torque;                // that it asked for [N m]
  // Of torque without motion.
  uint32_t edges_known[2];
  uint32_t still;  // how long it was given since A and B last changed [us]
  float part;      // of it that is left, 0 to 1
  // Of the winding.
  float heat;  // 1: as warm as it may be for hours
  uint64_t ticked;
} Paddle;

// Switched on, without torque; it does not know where it is until the switch at its lower end has
// closed once.
void paddle_begin(Paddle* paddle, const PaddleBuild* build, uint64_t now);

// The encoder's two pins, bit 0 A and bit 1 B; as often as they may change.
void paddle_turn(Paddle* paddle, uint8_t pins);
// The switches and the driver as they are now.
void paddle_inputs(Paddle* paddle, bool at_lower_end, bool hand, bool driver_fault);

// An output report from the computer; false: not used.
bool paddle_command(Paddle* paddle, const uint8_t report[PADDLE_REPORT], uint64_t now);
// The next input report.
void paddle_reading(Paddle* paddle, uint8_t report[PADDLE_REPORT], uint64_t now);
// The feature report.
void paddle_feature(const Paddle* paddle, uint8_t report[PADDLE_REPORT]);

// What the motor gets now, -1 to 1 of full voltage, positive towards the upper end. To be called at
// least every millisecond, whatever else goes on.
float paddle_drive(Paddle* paddle, uint64_t now);

// Where it is [rad].
float paddle_position(const Paddle* paddle);

#ifdef __cplusplus
}
#endif

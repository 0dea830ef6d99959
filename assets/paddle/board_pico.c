// The paddle on a Raspberry Pi Pico: pins, motor, USB. All else is in paddle.c.
#include <string.h>

#include "hardware/pwm.h"
#include "hardware/watchdog.h"
#include "paddle.h"
#include "pico/multicore.h"
#include "pico/stdlib.h"
#include "pico/unique_id.h"
#include "tusb.h"

enum {
  ENCODER_A = 2,  // and B at 3
  LOWER_END = 4,  // switch to ground
  HAND = 5,       // grip switch to ground
  MOTOR_A = 6,    // DRV8874 in PWM mode: IN1, and IN2 at 7, one PWM slice
  DRIVER_OK = 8,  // nFAULT, low: a fault
  AWAKE = 9,      // nSLEEP
  FULL = 6249     // of the PWM: 20 kHz of 125 MHz
};

static Paddle paddle;

// The other core does nothing else, so that no step is missed.
static void follow_encoder(void) {
  for (;;) paddle_turn(&paddle, (uint8_t)(gpio_get_all() >> ENCODER_A & 3));
}

static void drive(float share) {
  const uint16_t level = (uint16_t)((share < 0 ? -share : share) * FULL);
  pwm_set_both_levels(pwm_gpio_to_slice_num(MOTOR_A), share > 0 ? level : 0, share < 0 ? level : 0);
}

static void begin_pins(void) {
  const uint slice = pwm_gpio_to_slice_num(MOTOR_A);
  pwm_set_wrap(slice, FULL);
  pwm_set_both_levels(slice, 0, 0);
  pwm_set_enabled(slice, true);
  gpio_set_function(MOTOR_A, GPIO_FUNC_PWM);
  gpio_set_function(MOTOR_A + 1, GPIO_FUNC_PWM);
  for (uint pin = ENCODER_A; pin <= HAND; ++pin) gpio_pull_up(pin);
  gpio_pull_up(DRIVER_OK);
  gpio_init_mask(0xFu << ENCODER_A | 1u << DRIVER_OK | 1u << AWAKE);
  gpio_set_dir(AWAKE, GPIO_OUT);
  gpio_put(AWAKE, 1);
}

int main(void) {
  begin_pins();
  paddle_begin(&paddle, &paddle_build, time_us_64());
  paddle.pins = (uint8_t)(gpio_get_all() >> ENCODER_A & 3);
  multicore_launch_core1(follow_encoder);
  tusb_init();
  watchdog_enable(20, true);  // a firmware that hangs restarts, and a restart is without torque
  uint64_t due = time_us_64();
  for (;;) {
    watchdog_update();
    tud_task();
    paddle_inputs(&paddle, !gpio_get(LOWER_END), !gpio_get(HAND), !gpio_get(DRIVER_OK));
    drive(paddle_drive(&paddle, time_us_64()));
    if (time_us_64() >= due && tud_hid_ready()) {
      uint8_t report[PADDLE_REPORT];
      paddle_reading(&paddle, report, time_us_64());
      tud_hid_report(0, report, sizeof report);
      due = time_us_64() + PADDLE_PERIOD_US / 2;  // the host asks once a millisecond
    }
  }
}

uint16_t tud_hid_get_report_cb(uint8_t itf, uint8_t id, hid_report_type_t type, uint8_t* buffer,
                               uint16_t size) {
  (void)itf, (void)id;
  if (type != HID_REPORT_TYPE_FEATURE || size < PADDLE_REPORT) return 0;
  paddle_feature(&paddle, buffer);
  return PADDLE_REPORT;
}

void tud_hid_set_report_cb(uint8_t itf, uint8_t id, hid_report_type_t type, const uint8_t* buffer,
                           uint16_t size) {
  (void)itf, (void)id;
  if (type != HID_REPORT_TYPE_FEATURE && size == PADDLE_REPORT) {
    paddle_command(&paddle, buffer, time_us_64());
  }
}

// Unplugged or asleep, the computer commands nothing.
void tud_umount_cb(void) { paddle.pushing = false; }
void tud_suspend_cb(bool wakes) {
  (void)wakes;
  paddle.pushing = false;
}

// What it is on the bus: 1209:4c50, one HID interface, both ways once a millisecond.
uint8_t const* tud_descriptor_device_cb(void) {
  static const tusb_desc_device_t device = {.bLength = sizeof device,
                                            .bDescriptorType = TUSB_DESC_DEVICE,
                                            .bcdUSB = 0x0200,
                                            .bMaxPacketSize0 = CFG_TUD_ENDPOINT0_SIZE,
                                            .idVendor = 0x1209,
                                            .idProduct = 0x4C50,
                                            .bcdDevice = 0x0100,
                                            .iManufacturer = 1,
                                            .iProduct = 2,
                                            .iSerialNumber = 3,
                                            .bNumConfigurations = 1};
  return (uint8_t const*)&device;
}

uint8_t const* tud_hid_descriptor_report_cb(uint8_t itf) {
  (void)itf;
  return paddle_descriptor;
}

uint8_t const* tud_descriptor_configuration_cb(uint8_t index) {
  (void)index;
  static const uint8_t configuration[] = {
      TUD_CONFIG_DESCRIPTOR(1, 1, 0, TUD_CONFIG_DESC_LEN + TUD_HID_INOUT_DESC_LEN, 0, 100),
      TUD_HID_INOUT_DESCRIPTOR(0, 0, HID_ITF_PROTOCOL_NONE, PADDLE_DESCRIPTOR, 0x01, 0x81,
                               PADDLE_REPORT, 1)};
  return configuration;
}

uint16_t const* tud_descriptor_string_cb(uint8_t index, uint16_t language) {
  (void)language;
  // The number of its flash: what Limpid remembers of a paddle is no other's.
  static char serial[2 * PICO_UNIQUE_BOARD_ID_SIZE_BYTES + 1];
  const char* const texts[] = {"", "Limpid", "Limpid paddle", serial};
  if (serial[0] == '\0') pico_get_unique_board_id_string(serial, sizeof serial);
  static uint16_t out[32];
  uint16_t length = 1;
  if (index == 0) {
    out[1] = 0x0409;  // English
  } else {
    if (index >= 4) return NULL;
    length = (uint16_t)strlen(texts[index]);
    for (uint16_t i = 0; i < length; ++i) out[1 + i] = (uint16_t)texts[index][i];
  }
  out[0] = (uint16_t)(TUSB_DESC_STRING << 8 | (2 * length + 2));
  return out;
}

// The tables of a wave database and what its checksums cover.
#pragma once

#include <cstdint>

namespace ilf::projects {

inline constexpr std::uint32_t kWaveApplication = 0x494C4657;  ///< "ILFW"
inline constexpr std::uint32_t kWaveVersion = 1;

/// As in the reference's 1.1, but that a steady drive is kept too: models need the sine of amplitude 0.
inline constexpr const char* kWaveSchema = R"sql(
CREATE TABLE device(id INTEGER PRIMARY KEY,
  kind TEXT CHECK(kind IN('etl','amp','driver','projector','emulator')),
  model TEXT, serial TEXT, eye TEXT CHECK(eye IN('L','R','mono')), notes TEXT);
CREATE TABLE session(id INTEGER PRIMARY KEY, etl_id INT NOT NULL REFERENCES device, amp_id INT REFERENCES device,
  utc TEXT NOT NULL, method TEXT NOT NULL, p_offset_D REAL DEFAULT 0, p_gain REAL DEFAULT 1, noise_D REAL,
  software TEXT, provenance TEXT NOT NULL CHECK(provenance IN('measured','simulated','imported')));
CREATE TABLE wave(id INTEGER PRIMARY KEY, session_id INT NOT NULL REFERENCES session,
  family TEXT NOT NULL DEFAULT 'sine', freq_Hz REAL NOT NULL, drive_unit TEXT NOT NULL CHECK(drive_unit IN('V','A')),
  u_min REAL NOT NULL, u_max REAL NOT NULL, u_harm BLOB,
  temp_C REAL, periods_avg INT, settle_s REAL, phase0_s REAL NOT NULL DEFAULT 0,
  n INT NOT NULL, scale REAL NOT NULL, offset REAL NOT NULL, data BLOB NOT NULL,
  p_min REAL NOT NULL, p_max REAL NOT NULL, t_pmin_s REAL, t_pmax_s REAL, rms_period_D REAL, thd REAL, sha256 BLOB,
  CHECK(u_min<=u_max), CHECK(p_min<=p_max), UNIQUE(session_id,family,freq_Hz,u_min,u_max,temp_C));
CREATE INDEX wave_range ON wave(session_id,freq_Hz,p_min,p_max);
CREATE TABLE model(id INTEGER PRIMARY KEY, session_id INT REFERENCES session, kind TEXT, freq_Hz REAL, params BLOB,
  rms_fit_D REAL, max_fit_D REAL, valid_u BLOB, valid_T BLOB);
CREATE TABLE projector_delay(session_id INT, device_id INT, mode TEXT, delay_s REAL, sd_s REAL, n INT);
)sql";

/// Of `wave w, session s, device d`: all that makes a wave what it is, who recorded it and how.
inline constexpr const char* kWaveSeal =
    "sealed(w.id,w.session_id,w.family,w.freq_Hz,w.drive_unit,w.u_min,w.u_max,w.u_harm,w.temp_C,w.periods_avg,"
    "w.settle_s,w.phase0_s,w.n,w.scale,w.offset,w.data,w.p_min,w.p_max,w.t_pmin_s,w.t_pmax_s,w.rms_period_D,w.thd,"
    "s.id,s.etl_id,s.amp_id,s.utc,s.method,s.p_offset_D,s.p_gain,s.noise_D,s.software,s.provenance,"
    "d.id,d.kind,d.model,d.serial,d.eye,d.notes)";

/// Of `model m`; its params end with this.
inline constexpr const char* kModelSeal =
    "sealed(m.id,m.session_id,m.kind,m.freq_Hz,substr(m.params,1,length(m.params)-32),m.rms_fit_D,m.max_fit_D,"
    "m.valid_u,m.valid_T)";

}  // namespace ilf::projects

//! Video, radio, and remains of games and debugging.

use crate::navdata::wire::option;

option! {
    /// Watchdog of the controller.
    Watchdog, 8 {
        /// Raw.
        watchdog: i32 as i32,
    }
}

option! {
    /// A frame of the analogue converter.
    AdcDataFrame, 40 {
        /// Version of the frame.
        version: u32 as u32,
        /// Its bytes.
        data: [u8; 32] as [u8; 32],
    }
}

option! {
    /// The live video.
    VideoStream, 65 {
        /// Quantisation of the picture.
        quantisation: u8 as u8,
        /// Of the last picture.
        frame_bytes: u32 as u32,
        /// Of the last picture.
        frame_number: u32 as u32,
        /// Sequence number of the last AT command.
        at_sequence: u32 as u32,
        /// Mean time between AT commands.
        at_gap_mean_ms: u32 as u32,
        /// Variation of the time between AT commands.
        at_gap_variation: f32 as f32,
        /// Quality of the AT link.
        at_quality: u32 as u32,
        /// Current bit rate in bits per second.
        bit_rate: u32 as u32,
        /// Requested bit rate in bits per second.
        desired_bit_rate: u32 as u32,
        /// For debugging.
        data: [i32; 5] as [i32; 5],
        /// Fill of the TCP queue.
        tcp_queue: u32 as u32,
        /// Fill of the buffer before it.
        buffer_queue: u32 as u32,
    }
}

option! {
    /// Parrot's games.
    Games, 12 {
        /// Double taps.
        double_taps: u32 as u32,
        /// Finish lines.
        finish_lines: u32 as u32,
    }
}

option! {
    /// The video that is recorded to a USB key.
    HdVideoStream, 32 {
        /// Bit 0 buffer full, 8 key present, 9 recording, 10 key full.
        state: u32 as u32,
        /// Packets in the buffer.
        buffer_packets: u32 as u32,
        /// Size of the buffer.
        buffer_size: u32 as u32,
        /// Size of the key.
        key_kilobytes: u32 as u32,
        /// Room on the key.
        free_kilobytes: u32 as u32,
        /// Of the last picture.
        frame_number: u32 as u32,
        /// Until the key is full.
        remaining_s: u32 as u32,
    }
}

option! {
    /// The radio link.
    Wifi, 8 {
        /// As sent. Zero in every known capture, so its format is unknown.
        link_quality_bits: u32 as u32,
    }
}

impl Wifi {
    /// Link quality under the assumption of Parrot's phone application that the bits are a float that is 0 at
    /// best; returns 1 at best.
    pub fn quality_as_float(&self) -> f32 {
        1.0 - f32::from_bits(self.link_quality_bits)
    }
}

option! {
    /// Tag 27 of older firmware.
    Zimmu3000, 12 {
        /// Raw.
        lsb: i32 as i32,
        /// Raw.
        find: f32 as f32,
    }
}

impl Zimmu3000 {
    pub(super) const EXACT_BYTES: usize = Self::PAYLOAD_BYTES;
}

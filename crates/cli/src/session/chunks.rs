//! Work for the device in pieces, between which progress shows and a time limit can end it.

use std::{
    ops::{ControlFlow, Range},
    time::{Duration, Instant},
};

/// A chunk that takes less makes the next one longer, so that waiting for the device costs little.
const SHORT_CHUNK: Duration = Duration::from_millis(50);
/// Photons in the first chunk, as a power of two: about as many as the renderer takes in one dispatch.
const FIRST_PHOTONS: u32 = 18;
/// How many times as long as the first a chunk may become.
const GROWTH: u64 = 64;

/// Calls `work` with pieces of some numbers, the first of `first` numbers, until all are done, it says to stop, or the next piece would
/// probably end after the deadline; at least once if there are any.
pub(crate) fn in_chunks<E>(
    numbers: Range<u64>,
    first: u64,
    deadline: Option<Instant>,
    mut work: impl FnMut(Range<u64>) -> Result<ControlFlow<()>, E>,
) -> Result<(), E> {
    let mut chunk = first;
    let mut done = numbers.start;
    while done < numbers.end {
        let end = numbers.end.min(done.saturating_add(chunk));
        let start = Instant::now();
        if work(done..end)?.is_break() {
            break;
        }
        let now = Instant::now();
        done = end;
        if deadline.is_some_and(|deadline| now + (now - start) > deadline) {
            break;
        }
        if now - start < SHORT_CHUNK && chunk < first.saturating_mul(GROWTH) {
            chunk *= 2;
        }
    }
    Ok(())
}

/// How many photons to emit when `asked` are asked for and lights take `turns`: each its share exactly.
pub(crate) fn rounded_photons(asked: u64, turns: u64) -> u64 {
    asked.next_multiple_of(turns.max(1))
}

/// Photons in the first chunk: the same power of two for each turn.
pub(crate) fn first_photons(turns: u64) -> u64 {
    let turns = turns.max(1);
    turns << FIRST_PHOTONS.saturating_sub(turns.ilog2())
}

/// When photons must stop: they take at most half of the time that is left.
pub(crate) fn photon_deadline(now: Instant, deadline: Instant) -> Instant {
    now + deadline.saturating_duration_since(now) / 2
}

#[cfg(test)]
mod tests {
    use std::{convert::Infallible, thread::sleep};

    use super::*;

    /// The pieces that are done of some numbers.
    fn pieces(numbers: Range<u64>, first: u64, deadline: Option<Instant>, pause: Duration) -> Vec<Range<u64>> {
        let mut pieces = Vec::new();
        in_chunks(numbers, first, deadline, |piece| {
            pieces.push(piece);
            sleep(pause);
            Ok::<_, Infallible>(ControlFlow::Continue(()))
        })
        .unwrap_or_else(|never| match never {});
        pieces
    }

    #[test]
    fn chunks_cover_everything_once_and_grow() {
        let pieces = pieces(100..1000, 3, None, Duration::ZERO);
        assert_eq!(pieces[..3], [100..103, 103..109, 109..121]);
        assert!(pieces.windows(2).all(|pair| pair[0].end == pair[1].start));
        assert!(pieces.iter().all(|piece| piece.end - piece.start <= 3 * GROWTH));
        assert_eq!(pieces.last().unwrap().end, 1000);
    }

    #[test]
    fn a_deadline_stops_after_one_chunk_at_least() {
        let count = |deadline, pause| pieces(0..1000, 1, Some(deadline), pause).last().unwrap().end;
        assert_eq!(count(Instant::now(), Duration::ZERO), 1);
        // The second chunk would end at 120 ms.
        assert_eq!(count(Instant::now() + Duration::from_millis(100), Duration::from_millis(60)), 1);
        assert_eq!(count(Instant::now() + Duration::from_secs(3600), Duration::ZERO), 1000);
    }

    #[test]
    fn an_error_or_a_wish_ends_the_work() {
        let mut calls = 0;
        let mut work = |result| {
            in_chunks(0..10, 1, None, |_| {
                calls += 1;
                result
            })
        };
        assert_eq!((work(Ok(ControlFlow::Break(()))), work(Err("no"))), (Ok(()), Err("no")));
        assert_eq!(calls, 2);
        assert!(pieces(7..7, 1, None, Duration::ZERO).is_empty());
    }

    #[test]
    fn every_light_sends_equally_many_photons() {
        assert_eq!(
            [1, 2, 3, 0].map(|turns| rounded_photons(1_000_000, turns)),
            [1_000_000, 1_000_000, 1_000_002, 1_000_000]
        );
        assert_eq!(rounded_photons(0, 5), 0);
        for turns in 1..100 {
            let first = first_photons(turns);
            assert!(first.is_multiple_of(turns) && (first / turns).is_power_of_two());
            assert!(first <= 2 << FIRST_PHOTONS);
        }
    }

    #[test]
    fn photons_leave_half_of_the_time() {
        let now = Instant::now();
        assert_eq!(photon_deadline(now, now + Duration::from_secs(10)), now + Duration::from_secs(5));
        assert_eq!(photon_deadline(now, now), now);
    }
}

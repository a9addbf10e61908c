//! The long lane: all targets on all cores until the time is over.

use crate::{
    TARGETS,
    campaign::Campaign,
    chance::Chance,
    watch::{Slot, resident},
};
use std::{
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::{Duration, Instant},
};

/// Between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(30);
/// How long a worker stays with a target: with sessions, which are slow and of most kinds, three times as long.
const TURN: Duration = Duration::from_millis(300);

/// Runs for so many seconds.
///
/// # Panics
/// At the end, if inputs failed, or ran so long that they were reported.
pub fn run(seconds: u64, seed: u64) {
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let begun = Instant::now();
    let end = begun + Duration::from_secs(seconds);
    let slots: Vec<Slot> = (0..workers).map(Slot::new).collect();
    let campaigns: Vec<Campaign> = TARGETS.iter().map(|row| Campaign::new(row.0, slots.first())).collect();
    let slow = AtomicU64::new(0);
    eprintln!("fuzz: {workers} workers for {seconds} s, seed {seed}");
    thread::scope(|scope| {
        for (number, slot) in slots.iter().enumerate() {
            let campaigns = &campaigns;
            scope.spawn(move || work(campaigns, Chance::new(seed << 16 | number as u64), slot, end));
        }
        let (mut told, mut before) = (begun, vec![0; campaigns.len()]);
        while Instant::now() < end {
            thread::sleep(Duration::from_millis(500).min(end.saturating_duration_since(Instant::now())));
            slow.fetch_add(slots.iter().filter(|slot| slot.tell_long()).count() as u64, Ordering::Relaxed);
            if told.elapsed() >= PROGRESS {
                tell(&campaigns, &mut before, begun, told.elapsed());
                told = Instant::now();
            }
        }
    });
    tell(&campaigns, &mut vec![0; campaigns.len()], begun, begun.elapsed());
    let failed: usize = campaigns.iter().map(|campaign| campaign.failures().len()).sum();
    let slow = slow.into_inner();
    assert!(failed == 0 && slow == 0, "{failed} places failed and {slow} inputs took long; they are told above");
}

fn work(campaigns: &[Campaign], mut chance: Chance, slot: &Slot, end: Instant) {
    let turns = campaigns.iter().chain([&campaigns[campaigns.len() - 1]; 2]);
    for campaign in turns.cycle() {
        let turn = Instant::now() + TURN;
        while Instant::now() < turn.min(end) {
            campaign.advance(&mut chance, Some(slot));
        }
        if Instant::now() >= end {
            return;
        }
    }
}

fn tell(campaigns: &[Campaign], before: &mut [u64], begun: Instant, since: Duration) {
    let parts = campaigns.iter().zip(before).map(|(campaign, before)| {
        let executions = campaign.executions();
        let rate = (executions - *before) as f64 / since.as_secs_f64();
        *before = executions;
        let (kept, seen) = campaign.sizes();
        format!("{} {executions} ({rate:.0}/s, pool {kept}, seen {seen})", campaign.target.name)
    });
    let parts: Vec<String> = parts.collect();
    eprintln!("fuzz: {:4} s, {} MiB: {}", begun.elapsed().as_secs(), resident(), parts.join(", "));
}

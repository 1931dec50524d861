"use strict";
// Undo and redo of whatever is edited: one history, however it was changed.

class History {
  // Changes of one kind within this time are one, in milliseconds.
  static TOGETHER = 1000;
  // States that are kept; the oldest go.
  static MOST = 200;

  constructor() {
    this.states = [];
    this.now = -1; // index of the present state
    this.kind = "";
    this.changedAt = 0;
  }

  // Takes note of a state. Those of one kind in a row, such as typing, are undone together.
  record(state, kind) {
    const time = performance.now();
    const joins = kind && kind === this.kind && time - this.changedAt < History.TOGETHER;
    this.kind = kind;
    this.changedAt = time;
    this.states.length = this.now + 1;
    if (joins && this.now > 0) this.states[this.now] = state;
    else this.states.push(state);
    if (this.states.length > History.MOST) this.states.shift();
    this.now = this.states.length - 1;
  }

  // What comes next is undone apart from what was.
  pause() {
    this.kind = "";
  }

  canMove(by) {
    return this.now + by in this.states;
  }

  // The state before (−1) or after (1).
  move(by) {
    this.kind = "";
    if (this.canMove(by)) this.now += by;
    return this.states[this.now];
  }
}

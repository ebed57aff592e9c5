// The point that is asked about: where it is, and the answers there.

const kRetryMs = [30, 60, 120, 250, 500, 1000, 1000, 1000, 2000, 2000];

export class Probe {
  // position: three numbers in model units; within: contacts are asked for up to this distance
  constructor(position, within) {
    this.position = position;
    this.within = within;
    this.listeners = [];
    this.asking = false;
    this.isStale = false;
    this.retry = 0;
    this.timer = 0;
  }

  // listener(answer, error): called when the probe has moved, with no answer, and with answers.
  onChange(listener) { this.listeners.push(listener); }

  moveTo(position) {
    if (!position.every(Number.isFinite)) return;
    this.position = position;
    this.retry = 0;
    this.tell(null, null);
    this.ask();
  }

  setWithin(within) {
    if (!Number.isFinite(within) || within < 0) return;
    this.within = within;
    this.moveTo(this.position);
  }

  // Whether no further answer is to come, though one might be better.
  isGivenUp() { return this.retry >= kRetryMs.length; }

  tell(answer, error) { for (const listener of this.listeners) listener(answer, error); }

  // One question at a time: while one is asked, the place of the next one may change.
  async ask() {
    clearTimeout(this.timer);
    this.isStale = true;
    if (this.asking) return;
    this.asking = true;
    while (this.isStale) {
      this.isStale = false;
      const [x, y, z] = this.position;
      try {
        const reply = await fetch(`query?x=${x}&y=${y}&z=${z}&within=${this.within}`);
        if (!reply.ok) throw new Error(await reply.text());
        const answer = await reply.json();
        this.tell(answer, null);
        // Pages are missing: they are being read, and the next answer will be better.
        if (!this.isStale && needsPages(answer) && this.retry < kRetryMs.length)
          this.timer = setTimeout(() => this.ask(), kRetryMs[this.retry++]);
      } catch (error) {
        this.tell(null, error);
      }
    }
    this.asking = false;
  }
}

const kMaxContacts = 16;  // of an answer

// Whether a later answer may be better.
export function needsPages(answer) {
  const lacksContacts = !answer.contacts_complete && answer.contacts.length < kMaxContacts;
  return answer.status === 'degraded' || (answer.contacts_within > 0 && lacksContacts);
}

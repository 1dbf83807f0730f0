"""What a recovery says of itself on /diagnostics."""
from __future__ import annotations

from typing import Dict, List, Sequence, Tuple

from self_awareness.recovery.history import Action
from self_awareness.recovery.ladder import Climb
from self_awareness.stamps import utc

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus

_MOST_SHOWN = 10


def status(now: float, watched: int, climbs: Sequence[Climb], actions: Sequence[Action],
           blind: str, held: str) -> Tuple[int, str]:
    """Return level and message.

    Args:
        now: by the clock of the climbs [s].
        watched: components that there are rules for.
        climbs: of the rules that have something to mend.
        actions: the last ones.
        blind: why nothing is known; empty: it is known.
        held: until when nothing is done; empty: not held.
    """
    told = [f'gave up on {each.rule.component}: {each.gave_up}' for each in climbs
            if each.gave_up]
    given_up = bool(told)
    doing = [what(each) for each in actions[-1:] if not each.over]
    told += doing
    if held:
        told.append(f'does nothing {"more " if doing else ""}{held}')
    if blind:
        told.append(f'does nothing: {blind}')
    if not doing and not held and not blind:
        told += [_waiting(now, each) for each in climbs if not each.gave_up]
    if not told:
        return OK, f'watches {watched} components; {len(actions)} actions so far'
    return ERROR if given_up else WARN, '; '.join(told)


def values(actions: Sequence[Action], refused: Sequence[str], dry_run: bool) -> Dict[str, str]:
    """Return what a status has besides: the last actions, the newest first."""
    shown = {'dry run': str(dry_run).lower()}
    shown.update((f'cannot stop {number}', why) for number, why in enumerate(refused, 1))
    newest: List[Action] = [*reversed(actions)][:_MOST_SHOWN]
    shown.update((f'action {number}', f'{utc(each.begin)[:19]} UTC, {what(each)}')
                 for number, each in enumerate(newest, 1))
    return shown


def what(action: Action) -> str:
    """Return an action in words: 'stop /player (step 1 of 2), since /player silent: done: ...'."""
    text = (f'{action.action} (step {action.step} of {action.steps}), since {action.component}: '
            f'{action.kind}')
    if not action.over:
        return text
    return f'{text}: {"done" if action.success else "not done"}: {action.result}'


def _waiting(now: float, climb: Climb) -> str:
    number = min(climb.tried + 1, len(climb.rule.steps))
    when = (f'in {climb.next_at - now:.0f} s, if it does not recover' if climb.next_at > now
            else 'as soon as it fails so again')
    return (f'{climb.rule.component} is to be mended by step {number} of '
            f'{len(climb.rule.steps)} {when}')

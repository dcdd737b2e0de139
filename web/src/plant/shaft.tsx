// The shaft of a motor as a disc with a mark that turns with it.

export function Shaft({ turns, label }: { turns: number; label: string }) {
  const degrees = (turns - Math.floor(turns)) * 360;
  return (
    <svg class="shaft" role="img" aria-label={label} viewBox="-24 -24 48 48" width="58" height="58">
      <circle r="22" class="rim" />
      {Array.from({ length: 12 }, (_, hour) => (
        <line key={hour} y1="-22" y2={hour % 3 ? "-20" : "-18.5"} class="tick" transform={`rotate(${hour * 30})`} />
      ))}
      <g transform={`rotate(${degrees.toFixed(1)})`}>
        <circle r="14" class="hub" />
        <path d="M-2.6 -5.5V-14.4H2.6V-5.5Z" class="key" />
        <circle r="3" class="bore" />
      </g>
    </svg>
  );
}
